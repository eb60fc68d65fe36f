#include "core/analysis/space/progression.h"

#include "core/analysis/space/weighting.h"
#include "core/image/color.h"
#include "core/image/image_ops.h"
#include "core/material/map_names.h"
#include "nodes/common/exemplar_tiles.h"
#include "nodes/common/node_helpers.h"

namespace terrazzo {

namespace {

void compute(NodeContext& node) {
  const auto material = node.input<Material>("material");
  require_one_shape("material", *material);
  const NumberMap weights = weights_of_chosen(*material, node.texts("maps"));
  const FeaturesPtr features = weighted_features(*material, weights, exemplar_tiles(node, *material));
  const Size size = material->size();
  const double deviation = node.number("radius") * std::min(size.width, size.height);
  node.output("progression", progression_of(*features, deviation, node.flag("inverted"), node.task()));
}

}  // namespace

NodeType progression_node() {
  NodeType t;
  t.name = "progression";
  t.version = 5;
  t.category = "analysis";
  t.summary = "A smooth control map of how an exemplar changes: wear, moisture, density";
  t.help =
      "Many surfaces go from one state to another: clean to worn, dry to wet, bare to overgrown (progressively variant "
      "textures; Zhang et al. 2003). This blurs the chosen maps until only that change is left, takes the direction in "
      "which they then vary most (their first principal component), and replaces values by their rank: 0 at one end, 1 "
      "at the other, every value equally frequent. The lighter end, or that of larger values, is 1. As guidance it "
      "tells synthesis where along the way a pixel lies; with a target map of 0..1, painted or made with \"noise\", "
      "\"transfer\" puts each state where the target wants it. An image of one channel serves as well as a material.";
  t.inputs = {material_port("material", "the exemplar, or a grey image to be smoothed and equalized")};
  t.outputs = {image_port("progression", "1 channel, 0..1, of the material's size")};
  t.params = {
      {.name = "maps",
       .type = ParamType::texts,
       .fallback = Texts{},
       .help = "The maps in which the change shows; empty for all, by their default weights."},
      {.name = "radius",
       .type = ParamType::number,
       .fallback = 0.08,
       .help =
           "Standard deviation of the blur, as a fraction of the material's shorter side. Should exceed the size of "
           "single features: stones, tufts, cracks.",
       .min = 0,
       .max = 1},
      {.name = "inverted", .type = ParamType::boolean, .fallback = false, .help = "Exchanges the ends 0 and 1."},
      tiles_param(),
  };
  t.files_read = [](const Params&) { return color_config_files(); };
  t.memory_hint = [](const NodeContext& node) {
    return size_t(node.input<Material>("material")->size().area()) * 20 * sizeof(float);
  };
  t.compute = compute;
  t.preflight = [](const Params& params, const InputForecasts& inputs) {
    return preflight_analysis("maps", std::get<Texts>(params.at("maps")), inputs);
  };
  return t;
}

}  // namespace terrazzo
