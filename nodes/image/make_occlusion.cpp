#include "core/filter/occlusion.h"
#include "core/image/image_facts.h"
#include "nodes/common/horizon_params.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

void compute_make_occlusion(NodeContext& node) {
  const ImagePtr height = node.input<Image>("height");
  ImageInfo info = height->info();
  info.semantic = Semantic::ambient_occlusion;
  info.color_space = "raw";
  const HorizonOptions options = horizon_options_of(node, height);
  Operation operation = horizon_operation(height, options);
  operation.compute = [=, strength = node.number("strength")](auto in, const Rect& region, float* out) {
    occlusion_from_height(in[0], region, options, strength, out);
  };
  const ImagePtr occlusion = Image::computed(info, node.key(), std::move(operation));
  node.output("occlusion", materialized(occlusion, node.task()));
}

OutputForecasts infer_make_occlusion(const Params&, const InputForecasts& inputs) {
  const ImageFacts height = image_at(inputs, "height");
  require_one_channel("height", height);
  return {{"occlusion", forecast_of_image({height.size, 1, Semantic::ambient_occlusion, "raw"})}};
}

}  // namespace

NodeType make_occlusion_node() {
  NodeType t;
  t.name = "make_occlusion";
  t.version = 4;
  t.category = "image";
  t.summary = "Makes an ambient occlusion map from a height map";
  t.help =
      "How much of the sky each point sees: the horizon is searched in 16 directions up to the radius, and the "
      "cosine-weighted sky above it counts (horizon-based ambient occlusion; Bavoil and Sainz 2008). For the same "
      "surface use the height_scale of \"make_normal\" for the same surface.";
  t.inputs = {image_port("height", "the height map, 1 channel")};
  t.outputs = {image_port("occlusion", "1 where the whole sky is visible, 0 where none is")};
  t.params = {height_scale_param(),
              horizon_radius_param(),
              {.name = "strength",
               .type = ParamType::number,
               .fallback = 1.0,
               .help = "Factor on the darkening; 1 is as computed, more is darker.",
               .min = 0,
               .max = 4},
              derived_edges_param()};
  t.persist = Persist::payload;
  t.memory_hint = [](const NodeContext& node) {
    return size_t(node.input<Image>("height")->size().area()) * sizeof(float);
  };
  t.memory_ahead = [](const Params&, const InputForecasts& inputs) {
    return uint64_t(image_at(inputs, "height").size.value_or(Size{}).area()) * sizeof(float);
  };
  t.infer = infer_make_occlusion;
  t.compute = compute_make_occlusion;
  return t;
}

}  // namespace terrazzo
