#pragma once

#include <string>

#include <pybind11/pybind11.h>

/// Conversion of texts from Python. Every file of the package must include this header, so that all convert texts in
/// the same way.
namespace pybind11::detail {

/// Reports a text that cannot be encoded in UTF-8; otherwise the message would be that no function takes such
/// arguments.
template <>
struct type_caster<std::string> : string_caster<std::string> {
  bool load(handle text, bool convert) {
    if (string_caster<std::string>::load(text, convert)) return true;
    if (text && PyUnicode_Check(text.ptr()) != 0)
      throw value_error(std::string(str(repr(text))) + " is no Unicode text: it has a lone surrogate");
    return false;
  }
};

}  // namespace pybind11::detail
