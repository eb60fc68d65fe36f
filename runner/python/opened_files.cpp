#include "runner/python/opened_files.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <vector>

#include <pybind11/pybind11.h>
#include <pybind11/stl/filesystem.h>

#include "core/file/path_relation.h"
#include "runner/engine/checked.h"
#include "runner/python/current_node.h"
#include "runner/python/texts.h"

namespace terrazzo::python {

namespace py = pybind11;
namespace fs = std::filesystem;

namespace {

/// The folders of Python and its packages.
std::vector<fs::path> folders_of_python() {
  std::vector<fs::path> out;
  const py::module_ sys = py::module_::import("sys");
  for (const char* name : {"prefix", "base_prefix", "exec_prefix", "base_exec_prefix"})
    out.push_back(fs::weakly_canonical(py::cast<fs::path>(sys.attr(name))));
  const auto user = py::cast<std::string>(py::module_::import("site").attr("getusersitepackages")());
  out.push_back(fs::weakly_canonical(user));
  return out;
}

const std::vector<fs::path>& python_folders() {
  static const std::vector<fs::path>* const folders = new std::vector<fs::path>(folders_of_python());
  return *folders;
}

bool is_of_python(const fs::path& file) {
  if (file.extension() == ".py" || file.extension() == ".pyc") return true;
  const fs::path path = fs::weakly_canonical(file);
  return std::ranges::any_of(python_folders(), [&](const fs::path& folder) { return lies_in(folder, path); });
}

/// See "open" in Python's table of audit events: path, mode, flags.
void opened(const py::tuple& event) {
  const py::handle path = event[0];
  if (PyLong_Check(path.ptr())) return;  // a descriptor of an open file
  const auto file = py::cast<fs::path>(path);
  if (!is_of_python(file)) tell_opened(file.c_str(), py::cast<int>(event[2]));
}

int on_audit_event(const char* event, PyObject* arguments, void*) {
  if (!current_node() || std::strcmp(event, "open") != 0) return 0;
  try {
    const py::error_scope before;
    opened(py::reinterpret_borrow<py::tuple>(arguments));
  } catch (const std::exception&) {
    // Python will reject an invalid path.
  }
  return 0;
}

}  // namespace

void tell_opened_files() {
  static const bool told = [] {
    python_folders();
    if (PySys_AddAuditHook(&on_audit_event, nullptr) != 0) throw py::error_already_set();
    return true;
  }();
  (void)told;
}

}  // namespace terrazzo::python
