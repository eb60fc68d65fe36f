#include <algorithm>

#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "core/base/suggest.h"
#include "nodes/common/node_faults.h"
#include "nodes/common/registry.h"
#include "runner/python/bindings.h"
#include "runner/python/current_node.h"
#include "runner/python/values.h"

namespace terrazzo::python {

namespace py = pybind11;

namespace {

ValueType value_type(const std::string& name) {
  return static_cast<ValueType>(std::ranges::find(value_type_names, name) - value_type_names.begin());
}

ParamType param_type(const std::string& name) {
  for (int t = 0; t <= static_cast<int>(ParamType::path); t++)
    if (name_of(static_cast<ParamType>(t)) == name) return static_cast<ParamType>(t);
  throw py::value_error("there is no type \"" + name + "\" of parameters");
}

ParamValue param_value(const py::handle& value, ParamType type) {
  switch (type) {
    case ParamType::boolean:
      return py::cast<bool>(value);
    case ParamType::integer:
      return py::cast<int64_t>(value);
    case ParamType::number:
      return py::cast<double>(value);
    case ParamType::size: {
      const auto [width, height] = py::cast<std::pair<int, int>>(value);
      return Size{width, height};
    }
    case ParamType::numbers:
      return py::cast<Numbers>(value);
    case ParamType::texts:
      return py::cast<Texts>(value);
    default:
      return py::cast<std::string>(py::str(value));
  }
}

Param param_of(const py::dict& d) {
  Param out{.name = py::cast<std::string>(d["name"]), .type = param_type(py::cast<std::string>(d["type"]))};
  out.help = py::cast<std::string>(d["help"]);
  out.choices = py::cast<std::vector<std::string>>(d["choices"]);
  if (d.contains("default")) out.fallback = param_value(d["default"], out.type);
  return out;
}

/// Converts an exception of a Python function to an error of the node or to a cancellation.
[[noreturn]] void rethrow(py::error_already_set& raised) {
  if (raised.matches(py::module_::import("terrazzo._errors").attr("Cancelled"))) throw Cancelled();
  const py::object describe = py::module_::import("terrazzo._nodes").attr("_describe");
  throw Error(py::cast<std::string>(describe(raised.value(), raised.trace())));
}

template <typename T>
std::vector<Value> values_at(const NodeContext& node, const std::string& port) {
  std::vector<Value> out;
  for (auto& v : node.list<T>(port)) out.emplace_back(std::move(v));
  return out;
}

std::vector<Value> values_at(const NodeContext& node, const Port& port) {
  switch (port.type) {
    case ValueType::image:
      return values_at<Image>(node, port.name);
    case ValueType::material:
      return values_at<Material>(node, port.name);
    case ValueType::uv_map:
      return values_at<UvMap>(node, port.name);
    default:
      return values_at<Report>(node, port.name);
  }
}

/// A file, or all files in a folder, sorted by name.
void add_files(const std::filesystem::path& path, std::vector<std::filesystem::path>& out) {
  std::error_code failure;
  if (!std::filesystem::is_directory(path, failure)) return out.push_back(path);
  std::vector<std::filesystem::path> inside;
  std::filesystem::recursive_directory_iterator at(path, failure);
  for (std::error_code ended; !ended && at != end(at); at.increment(ended))
    if (at->is_regular_file(failure)) inside.push_back(at->path());
  std::ranges::sort(inside);
  out.insert(out.end(), inside.begin(), inside.end());
}

/// Calls the function with the node's inputs and parameters. Takes the GIL, which the caller of the run does not hold.
void compute(NodeContext& node, PyObject* function) {
  const py::gil_scoped_acquire hold;
  const Computes scope(node);
  try {
    py::dict arguments;
    for (const Port& p : node.type().inputs) {
      py::list values;
      for (const Value& v : values_at(node, p)) values.append(to_python(v));
      if (p.list)
        arguments[py::str(p.name)] = values;
      else if (!values.empty())
        arguments[py::str(p.name)] = values[0];
    }
    for (const auto& [name, value] : node.params()) arguments[py::str(name)] = to_python(value);
    const py::object result = py::reinterpret_borrow<py::object>(function)(**arguments);
    const Port& output = node.type().outputs.front();
    node.output(output.name, from_python(result, output.type));
  } catch (py::error_already_set& e) {
    rethrow(e);
  } catch (const py::builtin_exception& e) {
    throw Error(fmt::format("what it returned: {}", e.what()));
  }
}

/// The descriptor without the function and its code.
NodeType described(const py::dict& d) {
  NodeType t;
  t.name = py::cast<std::string>(d["name"]);
  t.version = py::cast<int>(d["version"]);
  t.category = "image";
  t.summary = py::cast<std::string>(d["summary"]);
  t.help = py::cast<std::string>(d["help"]);
  for (const auto& input : py::cast<py::list>(d["inputs"])) {
    const auto p = py::cast<py::dict>(input);
    t.inputs.push_back({.name = py::cast<std::string>(p["name"]),
                        .type = value_type(py::cast<std::string>(p["type"])),
                        .optional = py::cast<bool>(p["optional"]),
                        .list = py::cast<bool>(p["list"])});
  }
  if (t.inputs.empty()) t.category = "source";
  const auto output = py::cast<std::string>(d["output"]);
  t.outputs = {{.name = output, .type = value_type(output)}};
  for (const auto& param : py::cast<py::list>(d["params"])) t.params.push_back(param_of(py::cast<py::dict>(param)));
  // The content of files named by its parameters is part of the key.
  std::vector<std::string> paths;
  for (const Param& p : t.params)
    if (p.type == ParamType::path) paths.push_back(p.name);
  if (!paths.empty())
    t.files_read = [paths](const Params& params) {
      std::vector<std::filesystem::path> out;
      for (const std::string& p : paths)
        if (const auto& file = std::get<std::string>(params.at(p)); !file.empty()) add_files(file, out);
      return out;
    };
  t.origin.name = "Python";
  return t;
}

/// Throws Error, or the Python exception, for an invalid node.
void check_type(const py::dict& d) {
  NodeType t = described(d);
  t.compute = [](NodeContext&) {};
  if (const std::string fault = fault_of_node_type(t); !fault.empty()) throw Error(fault);
}

void register_type(const py::dict& d, const py::function& function) {
  NodeType t = described(d);
  t.origin.content = Hasher().add(py::cast<std::string>(d["source"])).digest();
  // Descriptors outlive the Python interpreter, so the function is never released.
  PyObject* kept = py::object(function).release().ptr();
  t.compute = [kept](NodeContext& node) { compute(node, kept); };
  register_node_type(std::move(t));
}

const NodeContext& node_here() {
  if (const NodeContext* node = current_node()) return *node;
  throw Error("this works inside of a node only");
}

}  // namespace

void bind_nodes(py::module_& module) {
  module.def("check_node", &check_type);
  module.def("register_node", &register_type);
  module.def(
      "report_progress", [](double fraction) { node_here().task().progress(fraction); }, py::arg("fraction"),
      "Inside of a node: how far it is, 0 to 1. Raises Cancelled once the run has been cancelled.");
  module.def(
      "add_note",
      [](const std::string& message) {
        node_here();
        current_node_to_note()->note(message);
      },
      py::arg("message"), "Inside of a node: something that its user should know; printed, and kept with the result.");
  module.def("node_type_names", [] {
    std::vector<std::string> out;
    for (const NodeType& t : node_types()) out.push_back(t.name);
    return out;
  });
}

}  // namespace terrazzo::python
