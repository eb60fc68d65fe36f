#pragma once

#include <functional>

#include "core/node/node.h"

/// What descriptors of image nodes share.
namespace terrazzo {

/// Parameter "edges": clamp or wrap beyond the image's border.
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

/// What a map may be used as, for parameters.
std::vector<std::string> semantic_choices();

/// Parameters "size" and "semantic" of nodes that generate an image, and what these and the channels say of it.
Param generated_size_param();
Param generated_semantic_param(const std::string& fallback, std::vector<std::string> choices = semantic_choices());
OutputForecasts forecast_of_generated(const Params& params, int channels);
/// The image that they describe, in the colour space of files with this semantic.
ImageInfo generated_info(const NodeContext& node, int channels);

/// The same pixel everywhere, computed on demand under the node's key; `info` without channels.
ImagePtr constant_image(const NodeContext& node, ImageInfo info, const Numbers& pixel);

/// Parameter "metres", the physical size of a surface. `empty`: what an empty list means.
Param metres_param(const std::string& empty);
/// What it says of a surface of `size`, whose width alone may be given; not known if it is empty.
PhysicalSize metres_of(const Numbers& given, Size size);

Port image_port(const std::string& name, const std::string& help);
Port material_port(const std::string& name, const std::string& help);

/// For rules of shapes: throws Errors if `param`, a list, names maps that the material certainly lacks, each about its
/// item.
void preflight_maps(const std::string& param, const std::vector<std::string>& wanted, const Forecast& material,
                    const std::string& whose = "the material");
/// For rules of shapes: throws Error about `port` if its material's maps certainly differ in aspect ratio.
void preflight_one_shape(const std::string& port, const InputForecasts& inputs);

/// For the rules of nodes that analyse maps of their "material" together, where their "mask", if they have one, allows
/// it: throws Errors for what certainly does not fit. `param` names the maps that are `wanted`.
void require_analysable_maps(const std::string& param, const std::vector<std::string>& wanted,
                             const InputForecasts& inputs);

/// The recipe digest of one of several lazy maps: the node's type and parameters, and the source map.
Digest map_recipe(const NodeContext& node, const Image& map);

/// The material with `change` applied to every map in `maps` (all if empty). Throws Error about "maps" if the material
/// lacks one.
MaterialPtr with_maps_changed(const MaterialPtr& material, const Texts& maps,
                              const std::function<ImagePtr(const Map&)>& change);

/// Warns of maps that are smaller than the material and so will be scaled up: likely a file of the wrong size. Those
/// that were already smaller in `known`, if given, have been reported before.
void warn_of_smaller_maps(NodeContext& node, const Material& material, const Material* known = nullptr);

/// Throws Error about `param` unless the material has a map of that name.
ImagePtr require_map(const std::string& param, const Material& material, const std::string& map);

/// A value per channel from a parameter that holds one for all, or one for each. Throws Error about `param`.
std::vector<double> per_channel(const Params& params, const std::string& param, int channels);

}  // namespace terrazzo
