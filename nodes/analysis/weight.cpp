#include <algorithm>

#include <fmt/format.h>

#include "core/analysis/space/weighting.h"
#include "core/filter/lone_feature.h"
#include "core/image_io/color.h"
#include "core/material/map_names.h"
#include "nodes/common/exemplar_lint.h"
#include "nodes/common/exemplar_tiles.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"
#include "nodes/common/synthesis/analysis_memory.h"

namespace terrazzo {

namespace {

/// Graphs are used with materials that have more maps or fewer. A name that no map has by itself is a mistake.
bool may_be_absent(const std::string& map) {
  return semantic_from(map).has_value();
}

/// A mask leaves such a thing out, or was made by someone who looked at the exemplar.
void tell_of_lone_feature(NodeContext& node, const Material& material) {
  const ImagePtr colour = material.find(Semantic::base_color);
  if (!colour || node.optional_input<Image>("mask")) return;
  node.task().check();
  if (const LoneFeature lone = lone_feature(*colour); lone.is_seen())
    node.warn(lone_feature_message("base_color", lone));
}

void compute_weight(NodeContext& node) {
  const auto material = node.input<Material>("material");
  tell_of_lone_feature(node, *material);
  const bool wraps = exemplar_tiles(node, *material);
  NumberMap weights = node.number_map("weights");
  for (auto at = weights.begin(); at != weights.end();) {
    const bool is_idle = !material->find(at->first) && may_be_absent(at->first);
    if (is_idle) node.note(fmt::format("weights: the material has no {}; its weight does nothing", at->first));
    at = is_idle ? weights.erase(at) : std::next(at);
  }
  node.output("features", weighted_features(*material, weights, wraps, node.optional_input<Image>("mask")));
}

/// Throws for maps that are known not to be weightable, each about its weight.
void require_weighted_maps(const Params& params, const Forecast& material) {
  std::vector<Error> missing;
  for (const auto& [name, unused] : std::get<NumberMap>(params.at("weights"))) {
    if (may_be_absent(name)) continue;
    try {
      preflight_maps("weights." + name, {name}, material);
    } catch (const Error& e) {
      missing.push_back(e);
    }
  }
  if (!missing.empty()) throw Errors(missing);
}

OutputForecasts infer_weight(const Params& params, const InputForecasts& inputs) {
  const Forecast& material = inputs.at("material").front();
  check_all([&] { require_weighted_maps(params, material); }, [&] { require_analysable_maps("material", {}, inputs); });
  return {{"features", {.size = material_size(material), .values = values_of(material)}}};
}

}  // namespace

NodeType weight_node() {
  NodeType t;
  t.name = "weight";
  t.version = 11;
  t.category = "analysis";
  t.summary = "Weights the maps of a material for analysis";
  t.help =
      "Sets how much each map, or each channel of a map, counts when neighbourhoods are compared. Colours are compared "
      "in Oklab, normals as unit vectors; maps are first normalised to equal variance, so that weights are comparable. "
      "Defaults: base colour 1, height and opacity 0.7, normal, metallic, emission and masks 0.5, roughness, occlusion "
      "and specular 0.3.";
  t.inputs = {{.name = "material", .type = ValueType::material, .help = "the exemplar"}, mask_port()};
  t.outputs = {{.name = "features", .type = ValueType::features, .help = "the weighted channels"}};
  t.params = {
      {.name = "weights",
       .type = ParamType::number_map,
       .fallback = NumberMap{},
       .help = "By map name, one weight or one per channel: {\"normal\": 2, \"base_color\": [1, 0.5, 0.5]}. Features "
               "of a map with more weight are better preserved; 0 leaves a map out. Weights of usual maps that the "
               "material "
               "lacks do nothing.",
       .min = 0,
       .max = 100},
      tiles_param(),
  };
  t.persist = Persist::digest;
  t.files_read = [](const Params&) { return color_config_files(); };
  t.compute = compute_weight;
  t.lint = [](const Params& params, const InputForecasts&) {
    Lints out;
    for (const auto& [name, weights] : std::get<NumberMap>(params.at("weights")))
      if (std::ranges::all_of(weights, [](double w) { return w == 0; }))
        out.push_back({fmt::format("\"weights.{0}\": the weight of {0} is 0: nothing in it is looked at", name)});
    return out;
  };
  t.infer = infer_weight;
  set_analysis_memory(t, "material", lattice_memory);
  return t;
}

}  // namespace terrazzo
