#pragma once

#include <functional>

#include "core/node/node.h"

/// Helpers for node descriptors.
namespace terrazzo {

/// Parameter "edges": whether images are clamped or wrapped beyond their borders.
Param edges_param();
Outside edges_of(const NodeContext& node);

/// Parameter "normal_y" of nodes that make normals.
Param normal_y_param();
NormalY normal_y_of(const NodeContext& node);

/// Parameter "height_scale" of nodes that read a height map as a surface.
Param height_scale_param();

/// Limit of parameters that are pixel values: allows heights in any unit, and catches typos.
inline constexpr double largest_sample = 1e6;
/// A parameter that is a pixel value.
Param sample_param(const std::string& name, double fallback, const std::string& help);

/// The choices of parameters that name a semantic.
std::vector<std::string> semantic_choices();

/// Parameters "size" and "semantic" of nodes that generate an image, and the forecast that follows from them.
Param generated_size_param();
Param generated_semantic_param(const std::string& fallback, std::vector<std::string> choices = semantic_choices());
OutputForecasts forecast_of_generated(const Params& params, int channels);
/// The description of the generated image, in the default colour space of its semantic.
ImageInfo generated_info(const NodeContext& node, int channels);

/// The same pixel everywhere, computed on demand under the node's key; `info` without channels.
ImagePtr constant_image(const NodeContext& node, ImageInfo info, const Numbers& pixel);

/// Parameter "metres", the physical size of a surface. `empty`: what an empty list means.
Param metres_param(const std::string& empty);
/// The parameter's value for a surface of `size` pixels. `given` may hold only the width; the result is unknown if it
/// is empty.
PhysicalSize metres_of(const Numbers& given, Size size);

Port image_port(const std::string& name, const std::string& help);
Port material_port(const std::string& name, const std::string& help);

/// For NodeType::infer: throws Errors if the list `param` names maps that the material is known to lack, each about its
/// item.
void preflight_maps(const std::string& param, const std::vector<std::string>& wanted, const Forecast& material,
                    const std::string& whose = "the material");
/// For NodeType::infer: throws Error about `port` if its material's maps are known to differ in aspect ratio.
void preflight_one_shape(const std::string& port, const InputForecasts& inputs);

/// For NodeType::infer of nodes that jointly analyse maps of "material", optionally restricted by "mask": throws Errors
/// for inputs that are known not to fit together. `param` lists the `wanted` maps.
void require_analysable_maps(const std::string& param, const std::vector<std::string>& wanted,
                             const InputForecasts& inputs);

/// The recipe digest of one of several lazy maps: covers the node's type and parameters, and the source map.
Digest map_recipe(const NodeContext& node, const Image& map);

/// The material with `change` applied to every map in `maps` (all if empty). Throws Error about "maps" if the material
/// lacks one.
MaterialPtr with_maps_changed(const MaterialPtr& material, const Texts& maps,
                              const std::function<ImagePtr(const Map&)>& change);

/// Warns of maps that are smaller than the material and will be scaled up: a file of the wrong size is likely. Skips
/// maps that are already smaller in `known`, which have been reported before.
void warn_of_smaller_maps(NodeContext& node, const Material& material, const Material* known = nullptr);

/// Throws Error about `param` unless the material has a map of that name.
ImagePtr require_map(const std::string& param, const Material& material, const std::string& map);

/// One value per channel, from a parameter with one value for all channels or one for each. Throws Error about `param`.
std::vector<double> per_channel(const Params& params, const std::string& param, int channels);

}  // namespace terrazzo
