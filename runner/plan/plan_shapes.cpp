#include "runner/plan/plan_shapes.h"

#include <fmt/format.h>

#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

/// Nullopt if there may be other maps.
std::optional<int> channels_of_all(const Forecast& material) {
  if (!material.possible_maps || !material.possible_maps->empty() || material.maps.empty()) return std::nullopt;
  int sum = 0;
  for (const std::string& map : material.maps) {
    const std::optional<int> channels = map_of(material, map).channels;
    if (!channels) return std::nullopt;
    sum += *channels;
  }
  return sum;
}

PlanShape shape_of(ValueType type, const Forecast& forecast) {
  if (type == ValueType::material) return {material_size(forecast), channels_of_all(forecast)};
  if (type != ValueType::image) return {forecast.size, std::nullopt};
  const auto image = forecast.images.find("");
  return image == forecast.images.end() ? PlanShape{} : PlanShape{image->second.size, image->second.channels};
}

}  // namespace

PlanShape shape_of(const GraphNode& node, const Forecasts& forecasts) {
  for (const Port& port : node.type->outputs) {
    const Forecast* forecast = forecasts.find_output({node.name, port.name});
    if (!forecast) continue;
    if (const PlanShape shape = shape_of(port.type, *forecast); shape.size || shape.channels) return shape;
  }
  return {};
}

std::string describe(const PlanShape& shape) {
  if (!shape.size && !shape.channels) return "-";
  std::string channels = shape.channels ? fmt::format("{}ch", *shape.channels) : "";
  if (!shape.size) return channels;
  return fmt::format("{}x{}{}{}", shape.size->width, shape.size->height, shape.channels ? " " : "", channels);
}

}  // namespace terrazzo
