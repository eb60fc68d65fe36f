#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "core/image/image_limits.h"
#include "runner/api/plugin.h"
#include "runner/cache/cache_limit.h"
#include "runner/python/bindings.h"
#include "runner/python/errors.h"
#include "runner/python/graphs.h"
#include "runner/python/values.h"
#include "runner/python/waiting.h"

/// The compiled part of the Python package; its public interface is in terrazzo/.
PYBIND11_MODULE(_terrazzo, module) {
  terrazzo::python::register_exceptions();
  terrazzo::python::bind_values(module);
  terrazzo::python::bind_graphs(module);
  terrazzo::python::bind_sessions(module);
  terrazzo::python::bind_nodes(module);
  module.def(
      "load_plugin", [](const std::filesystem::path& file) { return terrazzo::load_plugin(file).types; },
      pybind11::arg("file"), "Loads a plug-in, a shared library; gives the names of its node types.");
  module.def("set_memory_budget", &terrazzo::set_memory_budget);
  module.def("bytes_from", &terrazzo::size_from);
  module.attr("size_help") = terrazzo::size_help;
  pybind11::module_::import("atexit").attr("register")(pybind11::cpp_function(&terrazzo::python::end_work));
  terrazzo::load_plugins_of_environment();
}
