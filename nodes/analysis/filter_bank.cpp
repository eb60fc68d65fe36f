#include "core/analysis/space/filter_bank.h"

#include "core/analysis/space/weighting.h"
#include "core/image/image_facts.h"
#include "core/image/image_ops.h"
#include "core/image_io/color.h"
#include "core/material/map_names.h"
#include "nodes/common/exemplar_tiles.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

/// The map that "map" names, as grey values: lightness of colours, else the first channel.
ImagePtr grey_map(const NodeContext& node, const Material& material) {
  const std::string& name = node.text("map");
  ImagePtr map = name.empty() ? material.find(Semantic::base_color) : require_map("map", material, name);
  if (!map) map = material.maps().front().image;
  require_no_normals("map", facts_of(map->info()));
  return analysis_image(map);
}

void compute_filter_bank(NodeContext& node) {
  const auto material = node.input<Material>("material");
  const bool wraps = exemplar_tiles(node, *material);
  const ImagePtr grey = nearest_at_size(grey_map(node, *material), material->size());
  std::vector<double> first_only(size_t(grey->channels()), 0.0);
  first_only.front() = 1;
  const FeaturesPtr features = Features::make(grey->size(), {{grey, first_only}}, wraps);
  FilterResponses responses =
      mr8_responses(*weighted_planes(*features, node.task()), node.number("scale"), node.task());
  ImageInfo info{.size = grey->size(), .channels = 3, .semantic = Semantic::guidance};
  node.output("edges", Image::from_floats(info, std::move(responses.edges)));
  node.output("bars", Image::from_floats(info, std::move(responses.bars)));
  info.channels = 2;
  node.output("blobs", Image::from_floats(info, std::move(responses.blobs)));
}

OutputForecasts infer_filter_bank(const Params& params, const InputForecasts& inputs) {
  const std::string& map = std::get<std::string>(params.at("map"));
  const Forecast& material = inputs.at("material").front();
  require_analysable_maps("map", map.empty() ? Texts{} : Texts{map}, inputs);
  if (!map.empty()) require_no_normals("map", map_of(material, map));
  const auto responses = [size = material_size(material)](int channels) {
    return forecast_of_image(values_facts(size, Semantic::guidance, channels));
  };
  return {{"edges", responses(3)}, {"bars", responses(3)}, {"blobs", responses(2)}};
}

}  // namespace

NodeType filter_bank_node() {
  NodeType t;
  t.name = "filter_bank";
  t.version = 9;
  t.category = "analysis";
  t.summary = "Responses to edges, lines and blobs of several sizes (MR8)";
  t.help =
      "The maximum response filter bank MR8 (Varma & Zisserman 2005): 38 filters, of which edge and line filters keep "
      "only the strongest of 6 orientations. The 8 responses describe local structure independent of its direction. As "
      "guidance they keep lines and grain whole; with \"cluster\" they segment an image by texture. The map is first "
      "normalised to zero mean and unit variance; filters have zero mean and an L1 norm of 1. Values are signed: use "
      "\"levels\" or \"normalize\" to look at them.";
  t.inputs = {material_port("material", "the exemplar, or an image")};
  t.outputs = {
      image_port("edges",
                 "3 channels: strength of edges at scales of 1, 2 and 4 pixels (standard deviation), never negative"),
      image_port("bars", "3 channels, same scales: light lines are positive, dark lines negative"),
      image_port("blobs",
                 "2 channels: lighter than the surroundings, by a Gaussian and its Laplacian, both at 10 pixels")};
  t.params = {
      {.name = "map",
       .type = ParamType::text,
       .fallback = "",
       .help = "The map to filter: its lightness, or first channel. Empty for the base colour, or else the first map."},
      {.name = "scale",
       .type = ParamType::number,
       .fallback = 1.0,
       .help = "Factor on the size of all filters, 49 pixels. More responds to larger features.",
       .min = 0.25,
       .max = 4},
      tiles_param()};
  t.files_read = [](const Params&) { return color_config_files(); };
  t.memory_hint = [](const NodeContext& node) {
    // Spectra of 19 pairs of filters, and the responses.
    const double side = std::max(256.0, 256 * node.number("scale"));
    return size_t(19 * 16 * side * side) + size_t(node.input<Material>("material")->size().area()) * 40;
  };
  t.compute = compute_filter_bank;
  t.infer = infer_filter_bank;
  return t;
}

}  // namespace terrazzo
