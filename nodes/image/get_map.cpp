#include "nodes/common/node_helpers.h"

namespace terrazzo {

namespace {

void compute(NodeContext& node) {
  node.output("image", require_map("map", *node.input<Material>("material"), node.text("map")));
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
               .help = "The map's name, such as base_color, normal, height or roughness."}};
  t.persist = Persist::digest;
  t.preflight = [](const Params& params, const InputForecasts& inputs) {
    preflight_maps("map", {std::get<std::string>(params.at("map"))}, inputs.at("material").front());
    return Forecast{};
  };
  t.compute = compute;
  return t;
}

}  // namespace terrazzo
