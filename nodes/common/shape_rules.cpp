#include "nodes/common/shape_rules.h"

#include <algorithm>

namespace terrazzo {

const Forecast* forecast_at(const InputForecasts& inputs, const std::string& port, size_t wire) {
  const auto at = inputs.find(port);
  return at == inputs.end() || wire >= at->second.size() ? nullptr : &at->second[wire];
}

ImageFacts image_at(const InputForecasts& inputs, const std::string& port, size_t wire) {
  const Forecast* forecast = forecast_at(inputs, port, wire);
  if (!forecast) return {};
  const auto image = forecast->images.find("");
  return image == forecast->images.end() ? ImageFacts{} : image->second;
}

size_t wires_at(const InputForecasts& inputs, const std::string& port) {
  const auto at = inputs.find(port);
  return at == inputs.end() ? 0 : at->second.size();
}

Forecast forecast_of_image(const ImageFacts& image) {
  return {.images = {{"", image}}};
}

ShapeRule same_image_rule(const std::string& in, const std::string& out) {
  return [=](const Params&, const InputForecasts& inputs) {
    return OutputForecasts{{out, forecast_of_image(image_at(inputs, in))}};
  };
}

ImageFacts values_facts(std::optional<Size> size, std::optional<Semantic> semantic, int channels) {
  return {.size = size, .channels = channels, .semantic = semantic};
}

std::optional<Size> material_size(const Forecast& material) {
  const auto size_of = [&](const std::string& map) {
    const auto facts = material.images.find(map);
    return facts == material.images.end() ? std::nullopt : facts->second.size;
  };
  if (!material.possible_maps || material.maps.empty()) return std::nullopt;
  Size largest;
  for (const std::string& map : material.maps) {
    const std::optional<Size> size = size_of(map);
    if (!size) return std::nullopt;
    if (size->area() > largest.area()) largest = *size;
  }
  for (const std::string& map : *material.possible_maps) {
    const std::optional<Size> size = size_of(map);
    if (!size || (size->area() >= largest.area() && *size != largest)) return std::nullopt;
  }
  return largest;
}

bool certainly_has(const Forecast& material, const std::string& map) {
  return std::ranges::find(material.maps, map) != material.maps.end();
}

bool certainly_lacks(const Forecast& material, const std::string& map) {
  return material.possible_maps && !certainly_has(material, map) &&
         std::ranges::find(*material.possible_maps, map) == material.possible_maps->end();
}

ImageFacts map_of(const Forecast& material, const std::string& map) {
  const auto facts = material.images.find(map);
  return facts == material.images.end() || !certainly_has(material, map) ? ImageFacts{} : facts->second;
}

Forecast with_facts_changed(Forecast material, const std::function<void(const std::string& map, ImageFacts&)>& change) {
  for (const std::string& map : material.maps) change(map, material.images[map]);
  if (material.possible_maps)
    for (const std::string& map : *material.possible_maps) change(map, material.images[map]);
  return material;
}

}  // namespace terrazzo
