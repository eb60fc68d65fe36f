#pragma once

#include <functional>
#include <optional>
#include <string>

#include "core/node/node.h"

/// What rules of shapes (see NodeType::infer) are made of. Thread-safe.
namespace terrazzo {

using ShapeRule = std::function<OutputForecasts(const Params&, const InputForecasts&)>;

/// What is known of what comes through a wire of the port; null if there is none.
const Forecast* forecast_at(const InputForecasts& inputs, const std::string& port, size_t wire = 0);
/// The same of an image; nothing if there is none.
ImageFacts image_at(const InputForecasts& inputs, const std::string& port, size_t wire = 0);
/// How many wires come into a port.
size_t wires_at(const InputForecasts& inputs, const std::string& port);

Forecast forecast_of_image(const ImageFacts& image);

/// The rule of nodes whose only image is described as the one at `in`.
ShapeRule same_image_rule(const std::string& in = "image", const std::string& out = "image");

/// What an image in one channel of values is; `size` and semantic as far as they are known.
ImageFacts values_facts(std::optional<Size> size, std::optional<Semantic> semantic, int channels = 1);

/// The size of a material, that of its largest map, if that is certain.
std::optional<Size> material_size(const Forecast& material);
/// Whether it is certain that a material has a map, or has none of that name.
bool certainly_has(const Forecast& material, const std::string& map);
bool certainly_lacks(const Forecast& material, const std::string& map);
/// What is known of a map; nothing if there may be none.
ImageFacts map_of(const Forecast& material, const std::string& map);

/// A material whose maps, all that it may have, are described otherwise.
Forecast with_facts_changed(Forecast material, const std::function<void(const std::string& map, ImageFacts&)>& change);

}  // namespace terrazzo
