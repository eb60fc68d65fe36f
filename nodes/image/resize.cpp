#include <algorithm>
#include <cmath>

#include "core/filter/opacity_weights.h"
#include "core/filter/resample.h"
#include "nodes/common/derived_edges.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

int scaled(int length, double factor) {
  return std::max(1, int(std::lround(length * factor)));
}

/// The new size of a map. `material`: the size whose aspect ratio decides sides of 0.
std::optional<Size> target_size(const Params& params, std::optional<Size> map, std::optional<Size> material) {
  const Size asked = std::get<Size>(params.at("size"));
  if (asked.width && asked.height) return asked;
  if ((asked.width || asked.height) && !material) return std::nullopt;
  if (asked.width) return Size{asked.width, scaled(material->height, double(asked.width) / material->width)};
  if (asked.height) return Size{scaled(material->width, double(asked.height) / material->height), asked.height};
  if (!map) return std::nullopt;
  const double scale = std::get<double>(params.at("scale"));
  return Size{scaled(map->width, scale), scaled(map->height, scale)};
}

ImagePtr resized(NodeContext& node, const Map& map, const Material& material, Outside outside) {
  const Size size = *target_size(node.params(), map.image->size(), material.size());
  const std::string& filter = node.text("filter");
  const Digest recipe = map_recipe(node, *map.image);
  const bool averages = filter != "nearest" && size != map.image->size();
  const ImagePtr weights = averages ? opacity_weights(map.image, material.find(Semantic::opacity)) : nullptr;
  if (!weights) return resampled(map.image, size, filter, outside, recipe);
  node.note(map.name + ": colours count by their opacity");
  return resampled_by_weight(map.image, weights, size, filter, outside, recipe);
}

OutputForecasts infer_resize(const Params& params, const InputForecasts& inputs) {
  const Forecast& material = inputs.at("material").front();
  const Texts& chosen = std::get<Texts>(params.at("maps"));
  preflight_maps("maps", chosen, material);
  const std::optional<Size> size = material_size(material);
  return {{"material", with_facts_changed(material, [&](const std::string& map, ImageFacts& facts) {
             if (chosen.empty() || std::ranges::find(chosen, map) != chosen.end())
               facts.size = target_size(params, facts.size, size);
           })}};
}

void compute_resize(NodeContext& node) {
  const MaterialPtr material = node.input<Material>("material");
  const Outside outside = node.text("filter") == "nearest" ? Outside::clamp : derived_edges_of(node, *material);
  node.output("material", with_maps_changed(material, node.texts("maps"),
                                            [&](const Map& m) { return resized(node, m, *material, outside); }));
}

std::vector<std::string> check_resize(const Params& params) {
  const Size size = std::get<Size>(params.at("size"));
  if ((size.width || size.height) && std::get<double>(params.at("scale")) != 1)
    return {"\"scale\" and \"size\" cannot both be given; leave one of them out"};
  return {};
}

}  // namespace

NodeType resize_node() {
  NodeType t;
  t.name = "resize";
  t.version = 5;
  t.category = "image";
  t.summary = "Scales the maps of a material";
  t.help =
      "Scales to a given size, or by a factor. Colours stored as srgb_texture are filtered in linear light, and by "
      "their "
      "opacity if the material has one; normals as vectors that are renormalised, everything else as stored. Pixels "
      "are "
      "computed on demand.";
  t.inputs = {material_port("material", "the maps to scale; an image is taken as a material of one map")};
  t.outputs = {material_port("material", "the same maps, scaled")};
  t.params = {
      {.name = "size",
       .type = ParamType::size,
       .fallback = Size{0, 0},
       .help = "The size of all maps. If one side is 0, it follows from the aspect ratio; if both are, scale decides.",
       .min = 0,
       .max = 65536,
       .unit = "pixels"},
      {.name = "scale",
       .type = ParamType::number,
       .fallback = 1.0,
       .help = "Factor on each map's own size, rounded to whole pixels; used if no size is given.",
       .min = 0.0001,
       .max = 256},
      {.name = "filter",
       .type = ParamType::choice,
       .fallback = "auto",
       .help = "auto: lanczos3 to shrink, mitchell to enlarge, nearest for masks. All but nearest average over every "
               "source pixel when shrinking.",
       .choices = scaling_filter_names()},
      derived_edges_param(),
      {.name = "maps", .type = ParamType::texts, .fallback = Texts{}, .help = "The maps to scale; empty for all."},
  };
  t.persist = Persist::derived;
  t.compute = compute_resize;
  t.check = check_resize;
  t.infer = infer_resize;
  return t;
}

}  // namespace terrazzo
