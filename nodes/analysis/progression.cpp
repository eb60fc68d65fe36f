#include "core/analysis/space/progression.h"

#include "core/analysis/space/weighting.h"
#include "core/image_io/color.h"
#include "core/material/map_names.h"
#include "nodes/common/exemplar_tiles.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

void compute_progression(NodeContext& node) {
  const auto material = node.input<Material>("material");
  const NumberMap weights = weights_of_chosen(*material, node.texts("maps"));
  const FeaturesPtr features = weighted_features(*material, weights, exemplar_tiles(node, *material));
  const Size size = material->size();
  const double deviation = node.number("radius") * std::min(size.width, size.height);
  node.output("progression", progression_of(*features, deviation, node.flag("inverted"), node.task()));
}

OutputForecasts infer_progression(const Params& params, const InputForecasts& inputs) {
  require_analysable_maps("maps", std::get<Texts>(params.at("maps")), inputs);
  const std::optional<Size> size = material_size(inputs.at("material").front());
  return {{"progression", forecast_of_image(values_facts(size, Semantic::guidance))}};
}

}  // namespace

NodeType progression_node() {
  NodeType t;
  t.name = "progression";
  t.version = 9;
  t.category = "analysis";
  t.summary = "A smooth control map of how an exemplar changes: wear, moisture, density";
  t.help =
      "Many surfaces go from one state to another: clean to worn, dry to wet, bare to overgrown (progressively variant "
      "textures; Zhang et al. 2003). The chosen maps are blurred until only that change is left, projected on their "
      "first principal component, and histogram-equalised: 0 at one end, 1 at the other, lighter or larger values "
      "towards 1. Use it as guidance, or as the exemplar control of \"transfer\" with a target map of 0..1, painted or "
      "made with \"noise\". A one-channel image serves as well as a material.";
  t.inputs = {material_port("material", "the exemplar, or a grey image to smooth and equalise")};
  t.outputs = {image_port("progression", "1 channel, 0..1, of the material's size")};
  t.params = {
      {.name = "maps",
       .type = ParamType::texts,
       .fallback = Texts{},
       .help = "The maps that show the change; empty for all, by their default weights."},
      {.name = "radius",
       .type = ParamType::number,
       .fallback = 0.08,
       .help = "Standard deviation of the blur, as a fraction of the material's shorter side. Choose it larger than "
               "single features: stones, tufts, cracks.",
       .min = 0,
       .max = 1},
      {.name = "inverted", .type = ParamType::boolean, .fallback = false, .help = "Swaps 0 and 1."},
      tiles_param(),
  };
  t.files_read = [](const Params&) { return color_config_files(); };
  t.memory_hint = [](const NodeContext& node) {
    return size_t(node.input<Material>("material")->size().area()) * 20 * sizeof(float);
  };
  t.compute = compute_progression;
  t.infer = infer_progression;
  return t;
}

}  // namespace terrazzo
