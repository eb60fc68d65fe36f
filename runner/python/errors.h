#pragma once

#include <pybind11/pybind11.h>

#include "runner/api/job.h"
#include "runner/python/waiting.h"

/// Converts C++ exceptions to those of the package, defined in terrazzo/_errors.py.
namespace terrazzo::python {

/// A list of Problem objects.
pybind11::list problems_of(const std::vector<Problem>& problems, const Job& job, const char* severity);

/// Raises GraphError, whose problems have JSON pointers. The caller must hold the GIL.
[[noreturn]] void raise(const GraphError& error, const Job& job);

/// Runs `work` without the GIL and returns its result.
template <typename Work>
auto for_job(const Job& job, const Work& work) {
  try {
    const Unlocked free;
    return work();
  } catch (const GraphError& e) {
    raise(e, job);
  }
}

void register_exceptions();

}  // namespace terrazzo::python
