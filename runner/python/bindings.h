#pragma once

#include <pybind11/pybind11.h>

namespace terrazzo::python {

void bind_sessions(pybind11::module_& module);
void bind_nodes(pybind11::module_& module);

}  // namespace terrazzo::python
