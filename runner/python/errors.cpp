#include "runner/python/errors.h"

#include <pybind11/stl.h>

namespace terrazzo::python {

namespace py = pybind11;

namespace {

py::object ours(const char* name) {
  return py::module_::import("terrazzo._errors").attr(name);
}

void set_error(const py::object& exception) {
  PyErr_SetObject(py::type::of(exception).ptr(), exception.ptr());
}

}  // namespace

py::list problems_of(const std::vector<Problem>& problems, const Job& job, const char* severity) {
  const py::object type = ours("Problem");
  py::list out;
  for (const Problem& p : problems)
    out.append(type(p.where.empty() ? p.message : p.where + ": " + p.message, job.pointer_to(p), p.place.line,
                    p.place.column, p.code, p.node, p.file.empty() ? job.path().string() : p.file, severity));
  return out;
}

void raise(const GraphError& error, const Job& job) {
  set_error(ours("GraphError")(error.what(), problems_of(error.problems(), job, "error")));
  throw py::error_already_set();
}

void register_exceptions() {
  py::register_exception_translator([](std::exception_ptr thrown) {  // NOLINT(performance-unnecessary-value-param)
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const GraphError& e) {
      set_error(ours("GraphError")(e.what(), problems_of(e.problems(), Job::from_text("", e.file()), "error")));
    } catch (const Error& e) {
      set_error(ours("Error")(e.what()));
    } catch (const Cancelled& e) {
      set_error(ours("Cancelled")(e.what()));
    }
  });
}

}  // namespace terrazzo::python
