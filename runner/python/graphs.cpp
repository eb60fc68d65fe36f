#include "runner/python/graphs.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "core/base/suggest.h"
#include "core/file/atomic_file.h"
#include "graphs/text/stock_graphs.h"
#include "runner/python/errors.h"
#include "runner/python/values.h"

namespace terrazzo::python {

namespace py = pybind11;
namespace fs = std::filesystem;

namespace {

py::list descriptions_of(const std::vector<Port>& ports) {
  py::list out;
  for (const Port& p : ports) {
    py::dict port;
    port["name"] = p.name;
    port["type"] = name_of(p.type);
    port["help"] = p.help;
    port["optional"] = p.optional;
    port["list"] = p.list;
    out.append(port);
  }
  return out;
}

py::dict outline_of(const Job& job) {
  const JobOutline outline = job.outline();
  py::dict parameters, nodes;
  for (const JobParameter& p : outline.parameters) {
    py::dict parameter = description_of(p.param);
    parameter["group"] = p.group;
    parameters[py::str(p.param.name)] = parameter;
  }
  for (const JobNode& n : outline.nodes) {
    py::dict node, params;
    for (const Param& p : n.params) params[py::str(p.name)] = description_of(p);
    node["type"] = n.type;
    node["known"] = n.is_known;
    node["params"] = params;
    node["inputs"] = descriptions_of(n.inputs);
    node["outputs"] = descriptions_of(n.outputs);
    nodes[py::str(n.name)] = node;
  }
  py::dict out;
  out["parameters"] = parameters;
  out["nodes"] = nodes;
  return out;
}

py::list problems_in(const Job& job, bool warnings) {
  const Job own = job;
  const auto [errors, lint] =
      for_job(own, [&] { return std::pair(own.check(), warnings ? own.warnings() : std::vector<Problem>()); });
  py::list out = problems_of(errors, own, "error");
  out += problems_of(lint, own, "warning");
  return out;
}

CheckedHandle checked(const Job& job, const std::vector<std::string>& only) {
  const Job own = job;
  return for_job(own, [&] { return CheckedHandle{own.checked(only), own}; });
}

std::string stock_text(const std::string& name) {
  std::vector<std::string> names;
  for (const StockGraph& g : stock_graphs()) {
    if (g.name == name) return std::string(g.text);
    names.emplace_back(g.name);
  }
  throw Error("no graph \"" + name + "\" comes with terrazzo" + suggestion(name, names));
}

}  // namespace

py::dict description_of(const Param& param) {
  py::dict out;
  out["name"] = param.name;
  out["type"] = name_of(param.type);
  out["help"] = param.help;
  out["unit"] = param.unit;
  out["choices"] = param.choices;
  out["min"] = param.min;
  out["max"] = param.max;
  out["default"] = param.fallback ? to_python(*param.fallback) : py::none();
  out["required"] = !param.fallback;
  return out;
}

void bind_graphs(py::module_& module) {
  const py::class_<CheckedHandle> checked_type(module, "Checked");
  py::class_<Job>(module, "Job")
      .def_static("open", &Job::open)
      .def_static("from_text", &Job::from_text)
      .def("copy", [](const Job& job) { return Job(job); })
      .def("set_text", [](Job& job, const std::string& name, const std::string& value) { job.set_text(name, value); })
      .def("unset", [](Job& job, const std::string& name) { job.unset(name); })
      .def("preset", [](Job& job, const std::string& name) { job.preset(name); })
      .def("settings", [](Job& job, const fs::path& file) { job.settings(file); })
      .def("give",
           [](Job& job, const std::string& name, const py::object& value) { job.give(name, from_python(value)); })
      .def("outline", &outline_of)
      .def("value_of", &Job::value_of)
      .def("problems", &problems_in)
      .def("checked", &checked)
      .def("text", &Job::text)
      .def_property_readonly("path", &Job::path);
  module.def("write_file", [](const fs::path& path, const std::string& text) { write_whole_file(path, text); });
  module.def("stock_text", &stock_text);
  module.def("nearest", &nearest);
  module.def("suggestion", &suggestion);
}

}  // namespace terrazzo::python
