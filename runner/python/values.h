#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>

#include "core/node/node.h"
#include "runner/python/image_pixels.h"
#include "runner/python/texts.h"

/// Binds images, materials and other values as Python objects.
namespace terrazzo::python {

struct MaterialHandle {
  MaterialPtr material;
  std::vector<std::pair<std::string, ImageHandlePtr>> maps;
};

struct ReportHandle {
  ReportPtr report;
};

struct UvMapHandle {
  UvMapPtr map;
};

/// Values that Python can only pass on: features, an appearance, an index.
struct OtherValue {
  Value value;
};

pybind11::object to_python(const Value& value);
/// Throws TypeError if the object is no value, or not of this type.
Value from_python(const pybind11::handle& object);
Value from_python(const pybind11::handle& object, ValueType type);
pybind11::object to_python(const ParamValue& value);

void bind_values(pybind11::module_& module);

}  // namespace terrazzo::python
