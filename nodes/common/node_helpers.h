#pragma once

#include <functional>

#include "core/node/node.h"

/// What the descriptors of image-work nodes share.
namespace terrazzo {

/// Parameter "edges": what lies beyond the image's border.
Param edges_param();
Outside edges_of(const NodeContext& node);

/// Parameter "normal_y" of nodes that make normals.
Param normal_y_param();
NormalY normal_y_of(const NodeContext& node);

/// Parameter "height_scale" of nodes that read a height map as a surface.
Param height_scale_param();

/// Bounds of parameters that are pixel values: room for heights in any unit, none for slips.
inline constexpr double largest_sample = 1e6;
/// A parameter that is a pixel value.
Param sample_param(const std::string& name, double fallback, const std::string& help);

Port image_port(const std::string& name, const std::string& help);
Port material_port(const std::string& name, const std::string& help);

/// For nodes whose material has the maps of the one at `port`, or of the first there: their look ahead, see NodeType.
std::function<Forecast(const Params&, const InputForecasts&)> same_maps_as(const std::string& port);

/// For a look ahead: throws Error about `param` if it names maps that the material surely has not.
void preflight_maps(const std::string& param, const std::vector<std::string>& wanted, const Forecast& material,
                    const std::string& whose = "the material");
/// For a look ahead: throws Error about `port` if its material's maps surely differ in shape.
void preflight_one_shape(const std::string& port, const InputForecasts& inputs);

/// The look ahead of nodes that analyse maps of their "material" together. `param` names those `wanted`.
Forecast preflight_analysis(const std::string& param, const std::vector<std::string>& wanted,
                            const InputForecasts& inputs);

/// The recipe of one of several lazily computed maps: the node's type and parameters, and the map it is made from.
Digest map_recipe(const NodeContext& node, const Image& map);

/// The material with every map in `maps` (all if empty) replaced by what `change` makes of it. Throws Error about
/// parameter "maps" if it names a map that the material does not have.
MaterialPtr with_maps_changed(const MaterialPtr& material, const Texts& maps,
                              const std::function<ImagePtr(const Map&)>& change);

/// Warns of maps that are smaller than the material and so will be scaled up: likely a file of the wrong size. Those
/// that `known`, if there is one, held beside maps of that size have been spoken of before.
void warn_of_smaller_maps(NodeContext& node, const Material& material, const Material* known = nullptr);

/// Throws Error about `param` unless the material has a map of that name.
ImagePtr require_map(const std::string& param, const Material& material, const std::string& map);

/// A value for each of an image's channels out of a parameter that holds one for all or one for each.
std::vector<double> per_channel(const NodeContext& node, const std::string& param, int channels);

}  // namespace terrazzo
