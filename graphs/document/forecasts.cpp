#include "graphs/document/forecasts.h"

namespace terrazzo {

const Forecast* Forecasts::add(const GraphNode& node) {
  if (!node.type->preflight) return nullptr;
  const Forecast& forecast = nodes_[node.name] = node.type->preflight(node.params, inputs_of(node));
  // Of several outputs it is about the material.
  for (const Port& p : node.type->outputs)
    if (p.type == ValueType::material || node.type->outputs.size() == 1) outputs_[{node.name, p.name}] = forecast;
  return &forecast;
}

const Forecast* Forecasts::find(const std::string& node) const {
  const auto at = nodes_.find(node);
  return at == nodes_.end() ? nullptr : &at->second;
}

InputForecasts Forecasts::inputs_of(const GraphNode& node) const {
  InputForecasts inputs;
  for (const auto& [port, wires] : node.inputs)
    for (const Wire& w : wires) {
      const auto known = outputs_.find(w);
      inputs[port].push_back(known == outputs_.end() ? Forecast{} : known->second);
    }
  return inputs;
}

}  // namespace terrazzo
