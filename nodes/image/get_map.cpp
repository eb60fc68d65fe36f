#include "core/image_io/color.h"
#include "nodes/common/color_space.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

/// A constant image in place of a missing map.
ImagePtr constant(const NodeContext& node, Size size) {
  ImageInfo info{.size = size};
  info.semantic = semantic_from(node.text("map")).value_or(Semantic::data);
  info.color_space = assumed_color_space(info.semantic, Depth::u16);
  return constant_image(node, info, node.numbers("otherwise"));
}

void compute_get_map(NodeContext& node) {
  const auto material = node.input<Material>("material");
  const std::string& map = node.text("map");
  const bool is_lacking = !node.numbers("otherwise").empty() && !material->find(map);
  node.output("image", is_lacking ? constant(node, material->size()) : require_map("map", *material, map));
}

OutputForecasts infer_get_map(const Params& params, const InputForecasts& inputs) {
  const std::string& map = std::get<std::string>(params.at("map"));
  const Numbers& otherwise = std::get<Numbers>(params.at("otherwise"));
  const Forecast& material = inputs.at("material").front();
  ImageFacts image = map_of(material, map);
  if (otherwise.empty()) {
    preflight_maps("map", {map}, material);
    // It must have the map, whatever is known of it.
    if (const auto facts = material.images.find(map); facts != material.images.end()) image = facts->second;
  } else if (certainly_lacks(material, map)) {
    image = values_facts(material_size(material), semantic_from(map).value_or(Semantic::data), int(otherwise.size()));
  }
  return {{"image", forecast_of_image(image)}};
}

}  // namespace

NodeType get_map_node() {
  NodeType t;
  t.name = "get_map";
  t.category = "image";
  t.summary = "Takes one map out of a material";
  t.help =
      "Gives one map of a material as an image, for nodes that work on images. \"make_material\" puts it back, changed "
      "or not.";
  t.inputs = {material_port("material", "the material")};
  t.outputs = {image_port("image", "the map")};
  t.params = {{.name = "map",
               .type = ParamType::text,
               .help = "The map's name, such as base_color, normal, height or roughness."},
              {.name = "otherwise",
               .type = ParamType::numbers,
               .fallback = Numbers{},
               .help = "The value, or one for each channel, of a map that the material may lack: [0] for metallic. "
                       "Empty: it must have the map.",
               .min = 0,
               .max = 65504,
               .max_count = 4}};
  t.persist = Persist::digest;
  t.infer = infer_get_map;
  t.compute = compute_get_map;
  return t;
}

}  // namespace terrazzo
