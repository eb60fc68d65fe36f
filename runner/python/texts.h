#pragma once

#include <string>

#include <pybind11/pybind11.h>

/// Texts that come from Python. To be included by every file of the package: it decides how all of them read texts.
namespace pybind11::detail {

/// Says what is wrong with a text that has no UTF-8 form; else it would be said that no function takes such arguments.
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
