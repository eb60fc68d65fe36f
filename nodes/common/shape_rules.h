#pragma once

#include <functional>
#include <optional>
#include <string>

#include "core/node/node.h"

/// Building blocks for NodeType::infer. Thread-safe.
namespace terrazzo {

using ShapeRule = std::function<OutputForecasts(const Params&, const InputForecasts&)>;

/// The forecast at a wire of the port; null if there is no such wire.
const Forecast* forecast_at(const InputForecasts& inputs, const std::string& port, size_t wire = 0);
/// The same for an image; without facts if there is none.
ImageFacts image_at(const InputForecasts& inputs, const std::string& port, size_t wire = 0);
/// The number of wires into a port.
size_t wires_at(const InputForecasts& inputs, const std::string& port);

Forecast forecast_of_image(const ImageFacts& image);

/// For nodes whose only output has the same description as the image at `in`.
ShapeRule same_image_rule(const std::string& in = "image", const std::string& out = "image");

/// The facts of an image of values; `size` and `semantic` may be unknown.
ImageFacts values_facts(std::optional<Size> size, std::optional<Semantic> semantic, int channels = 1);

/// The size of a material (that of its largest map), if known.
std::optional<Size> material_size(const Forecast& material);
/// Whether a material is known to have, or to lack, a map of this name.
bool certainly_has(const Forecast& material, const std::string& map);
bool certainly_lacks(const Forecast& material, const std::string& map);
/// The facts of a map; empty if the material may lack it.
ImageFacts map_of(const Forecast& material, const std::string& map);

/// Applies `change` to the facts of all certain and possible maps.
Forecast with_facts_changed(Forecast material, const std::function<void(const std::string& map, ImageFacts&)>& change);

}  // namespace terrazzo
