#pragma once

#include <pybind11/pybind11.h>

#include "runner/api/job.h"

namespace terrazzo::python {

/// A checked graph, and its job for messages.
struct CheckedHandle {
  CheckedJob checked;
  Job job;
};

/// A parameter's description as a dictionary.
pybind11::dict description_of(const Param& param);

void bind_graphs(pybind11::module_& module);

}  // namespace terrazzo::python
