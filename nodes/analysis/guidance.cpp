#include <fmt/format.h>

#include "core/analysis/space/feature_distance.h"
#include "core/analysis/space/weighting.h"
#include "core/image_io/color.h"
#include "core/material/map_names.h"
#include "nodes/common/exemplar_tiles.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"
#include "nodes/common/synthesis/analysis_memory.h"

namespace terrazzo {

namespace {

void compute_guidance(NodeContext& node) {
  const auto material = node.input<Material>("material");
  EdgeOptions options;
  options.maps = node.texts("maps");
  if (node.number("threshold") > 0) options.threshold = node.number("threshold");
  options.smoothing = node.number("smoothing");
  options.wraps = exemplar_tiles(node, *material);
  options.mask = node.optional_input<Image>("mask");
  const Size size = material->size();
  const Edges edges = find_edges(*material, options, node.task());
  node.task().check();
  const double limit = node.number("reach") * std::min(size.width, size.height);
  node.output("distance", feature_distance(edges, size, options.wraps, float(limit)));
  const ImageInfo mask{.size = size, .channels = 1, .semantic = Semantic::mask, .depth = Depth::u8};
  node.output("gradients",
              Image::from_floats({.size = size, .channels = 2, .semantic = Semantic::guidance}, edges.gradients));
  node.output("edges", Image::from_floats(mask, {edges.mask.begin(), edges.mask.end()}));
  if (!options.threshold)
    node.note(fmt::format("edges are where strength exceeds {:.3f} (chosen automatically)", edges.threshold));
}

OutputForecasts infer_guidance(const Params& params, const InputForecasts& inputs) {
  require_analysable_maps("maps", std::get<Texts>(params.at("maps")), inputs);
  const std::optional<Size> size = material_size(inputs.at("material").front());
  return {{"distance", forecast_of_image(values_facts(size, Semantic::guidance))},
          {"edges", forecast_of_image(values_facts(size, Semantic::mask))},
          {"gradients", forecast_of_image(values_facts(size, Semantic::guidance, 2))}};
}

}  // namespace

NodeType guidance_node() {
  NodeType t;
  t.name = "guidance";
  t.version = 11;
  t.category = "analysis";
  t.summary = "Extracts edges and the signed feature distance from a material's maps";
  t.help =
      "Colours alone cannot tell the middle of a brick from its rim; the distance to the nearest edge can. Connected "
      "to pca as guidance, it keeps bricks, cracks and joints whole (signed feature distance, Lefebvre & Hoppe 2006; "
      "edges from any map of a material, Rudolph 2018). Look at the edges output to judge the threshold.";
  t.inputs = {{.name = "material", .type = ValueType::material, .help = "the exemplar"}, mask_port()};
  t.outputs = {
      {.name = "distance", .type = ValueType::image, .help = "pixels to the nearest edge, negative inside edges"},
      {.name = "edges", .type = ValueType::image, .help = "the edges, 1 on an edge"},
      {.name = "gradients",
       .type = ValueType::image,
       .help = "x and y gradients of the maps' first principal component: further guidance, which tells a feature's "
               "sides apart"}};
  t.params = {
      {.name = "maps",
       .type = ParamType::texts,
       .fallback = Texts{},
       .help = "The maps to look for edges in; empty for all, by their default weights."},
      {.name = "threshold",
       .type = ParamType::number,
       .fallback = 0.0,
       .help = "Edge strength, relative to the strongest, above which a pixel is an edge. Higher keeps fewer edges; 0 "
               "chooses automatically.",
       .min = 0,
       .max = 1},
      {.name = "smoothing",
       .type = ParamType::number,
       .fallback = 1.0,
       .help = "Standard deviation of the blur before edge detection; more ignores finer detail.",
       .min = 0,
       .max = 16,
       .unit = "pixels"},
      {.name = "reach",
       .type = ParamType::number,
       .fallback = 0.1,
       .help = "Distances are limited to this fraction of the exemplar's shorter side. Lower guides only near edges.",
       .min = 0.005,
       .max = 1},
      tiles_param(),
  };
  t.files_read = [](const Params&) { return color_config_files(); };
  t.compute = compute_guidance;
  t.infer = infer_guidance;
  set_analysis_memory(t, "material", {.per_pixel = 16, .per_value = 8});
  return t;
}

}  // namespace terrazzo
