#include "runner/python/errors.h"

#include <pybind11/stl.h>

namespace terrazzo::python {

namespace py = pybind11;

namespace {

py::object ours(const char* name) {
  return py::module_::import("terrazzo._errors").attr(name);
}

/// A message as a Python string; bytes of file names that are not UTF-8 are shown as "\\x80".
py::object text_of(const std::string& message) {
  PyObject* text = PyUnicode_DecodeUTF8(message.data(), static_cast<Py_ssize_t>(message.size()), "backslashreplace");
  if (text == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::object>(text);
}

void set_error(const py::object& exception) {
  PyErr_SetObject(py::type::of(exception).ptr(), exception.ptr());
}

}  // namespace

py::list problems_of(const std::vector<Problem>& problems, const Job& job, const char* severity) {
  const py::object type = ours("Problem");
  py::list out;
  for (const Problem& p : problems)
    out.append(type(text_of(p.where.empty() ? p.message : p.where + ": " + p.message), text_of(job.pointer_to(p)),
                    p.place.line, p.place.column, p.code, text_of(p.node),
                    text_of(p.file.empty() ? job.path().string() : p.file), severity));
  return out;
}

void raise(const GraphError& error, const Job& job) {
  set_error(ours("GraphError")(text_of(error.what()), problems_of(error.problems(), job, "error")));
  throw py::error_already_set();
}

void register_exceptions() {
  py::register_exception_translator([](std::exception_ptr thrown) {  // NOLINT(performance-unnecessary-value-param)
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const GraphError& e) {
      set_error(
          ours("GraphError")(text_of(e.what()), problems_of(e.problems(), Job::from_text("", e.file()), "error")));
    } catch (const Error& e) {
      set_error(ours("Error")(text_of(e.what())));
    } catch (const Cancelled& e) {
      set_error(ours("Cancelled")(text_of(e.what())));
    }
  });
}

}  // namespace terrazzo::python
