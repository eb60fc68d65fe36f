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

/// Parameters "size" and "semantic" of nodes that generate an image, and their preflight, which knows the size.
Param generated_size_param();
Param generated_semantic_param(const std::string& fallback, std::vector<std::string> choices = semantic_choices());
Forecast forecast_of_generated(const Params& params, const InputForecasts& inputs);
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

/// The preflight of nodes whose material has the maps of the (first) one at `port`, see NodeType.
std::function<Forecast(const Params&, const InputForecasts&)> same_maps_as(const std::string& port);

/// For preflights: throws Errors if `param`, a list, names maps that the material certainly lacks, each about its item.
void preflight_maps(const std::string& param, const std::vector<std::string>& wanted, const Forecast& material,
                    const std::string& whose = "the material");
/// For preflights: throws Error about `port` if its material's maps certainly differ in aspect ratio.
void preflight_one_shape(const std::string& port, const InputForecasts& inputs);

/// What an analysis holds at its peak, in bytes for each pixel of the exemplar and for each value of a pixel in all
/// maps together. Measured with tests/bench/memory_budget.sh.
struct AnalysisMemory {
  uint64_t per_pixel = 0, per_value = 0;

  size_t of(const Material& exemplar) const;
  size_t of(const Features& features) const;
  /// 0 if the sizes of the maps are not known yet.
  uint64_t of(const Forecast& exemplar) const;
};
/// Of finding the lattice, which also tells whether an exemplar tiles.
inline constexpr AnalysisMemory lattice_memory{32, 6};
/// Of an index, with what making it and synthesis from it hold besides.
inline constexpr AnalysisMemory index_memory{48, 0};
/// The preflight and memory_hint of nodes that look at features.
void set_memory_of_features(NodeType& type, const AnalysisMemory& memory);

/// The preflight of nodes that analyse maps of their "material" together. `param` names those `wanted`.
Forecast preflight_analysis(const std::string& param, const std::vector<std::string>& wanted,
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
std::vector<double> per_channel(const NodeContext& node, const std::string& param, int channels);

}  // namespace terrazzo
