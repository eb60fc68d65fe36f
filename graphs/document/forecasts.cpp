#include "graphs/document/forecasts.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/file/read_guard.h"

namespace terrazzo {

namespace {

/// Forecasts must not reveal anything about files that may not be read.
void check_reads(const GraphNode& node) {
  if (!ReadGuard::is_set() || node.type->is_sink()) return;
  for (const Param& p : node.type->params) {
    const auto value = node.params.find(p.name);
    if (p.type != ParamType::path || value == node.params.end()) continue;
    const std::string& path = std::get<std::string>(value->second);
    try {
      if (!path.empty()) ReadGuard::check(path);
    } catch (const Error& e) {
      throw Error(p.name, e.what());
    }
  }
  if (!node.type->files_read) return;
  for (const std::filesystem::path& file : node.type->files_read(node.params)) ReadGuard::check(file);
}

}  // namespace

const Forecast* Forecasts::add(const GraphNode& node) {
  const NodeType& type = *node.type;
  if (!type.infer && !type.preflight) return nullptr;
  check_reads(node);
  const InputForecasts inputs = inputs_of(node);
  OutputForecasts outputs;
  if (type.infer) outputs = type.infer(node.params, inputs);
  Forecast whole;
  if (type.preflight) whole = type.preflight(node.params, inputs);
  // If there are several outputs, preflight describes the material.
  auto main = std::ranges::find(type.outputs, ValueType::material, &Port::type);
  if (main == type.outputs.end()) main = type.outputs.begin();
  if (main != type.outputs.end()) {
    Forecast& known = outputs.emplace(main->name, whole).first->second;
    known.files = std::move(whole.files);
    whole = known;
  }
  for (auto& [port, forecast] : outputs) outputs_[{node.name, port}] = {type.find_output(port)->type, forecast};
  return &(nodes_[node.name] = std::move(whole));
}

const Forecast* Forecasts::find(const std::string& node) const {
  const auto at = nodes_.find(node);
  return at == nodes_.end() ? nullptr : &at->second;
}

const Forecast* Forecasts::find_output(const Wire& output) const {
  const auto at = outputs_.find(output);
  return at == outputs_.end() ? nullptr : &at->second.forecast;
}

InputForecasts Forecasts::inputs_of(const GraphNode& node) const {
  InputForecasts inputs;
  for (const auto& [port, wires] : node.inputs)
    for (const Wire& w : wires) {
      const auto known = outputs_.find(w);
      inputs[port].push_back(known == outputs_.end() ? Forecast{}
                                                     : converted(known->second.forecast, known->second.type,
                                                                 node.type->find_input(port)->type));
    }
  return inputs;
}

}  // namespace terrazzo
