#include "nodes/common/node_helpers.h"

namespace terrazzo {

namespace {

void compute_solid(NodeContext& node) {
  const Numbers& value = node.numbers("value");
  node.output("image", constant_image(node, generated_info(node, int(value.size())), value));
}

}  // namespace

NodeType solid_node() {
  NodeType t;
  t.name = "solid";
  t.category = "source";
  t.summary = "One colour or value everywhere";
  t.help =
      "For what a scan lacks: a constant roughness, a metallic map of zeros, a tint to blend with. Pixels are computed "
      "on demand, so a huge one costs nothing.";
  t.outputs = {image_port("image", "as many channels as value has numbers")};
  t.params = {{.name = "value",
               .type = ParamType::numbers,
               .fallback = Numbers{0.5},
               .help = "One number for grey, three for a colour, two or four with alpha; colours as a file would hold "
                       "them (sRGB for base_color).",
               .min = 0,
               .max = 65504,
               .min_count = 1,
               .max_count = 4},
              generated_size_param(),
              generated_semantic_param("data")};
  t.persist = Persist::derived;
  t.infer = [](const Params& params, const InputForecasts&) {
    return forecast_of_generated(params, int(std::get<Numbers>(params.at("value")).size()));
  };
  t.compute = compute_solid;
  return t;
}

}  // namespace terrazzo
