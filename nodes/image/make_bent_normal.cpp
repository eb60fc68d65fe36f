#include "core/image/image_facts.h"
#include "nodes/common/horizon_params.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

void compute_make_bent_normal(NodeContext& node) {
  const ImagePtr height = node.input<Image>("height");
  ImageInfo info = height->info();
  info.channels = 3;
  info.semantic = Semantic::normal;
  info.color_space = "raw";
  info.normal_y = normal_y_of(node);
  const HorizonOptions options = horizon_options_of(node, height);
  const SkyWeight weight = node.text("sky") == "uniform" ? SkyWeight::uniform : SkyWeight::cosine;
  Operation operation = horizon_operation(height, options);
  operation.compute = [=, normal_y = info.normal_y](auto in, const Rect& region, float* out) {
    bent_normals_from_height(in[0], region, options, weight, normal_y, out);
  };
  const ImagePtr normal = Image::computed(info, node.key(), std::move(operation));
  node.output("normal", materialized(normal, node.task()));
}

OutputForecasts infer_make_bent_normal(const Params&, const InputForecasts& inputs) {
  const ImageFacts height = image_at(inputs, "height");
  require_one_channel("height", height);
  return {{"normal", forecast_of_image({height.size, 3, Semantic::normal, "raw"})}};
}

}  // namespace

NodeType make_bent_normal_node() {
  NodeType t;
  t.name = "make_bent_normal";
  t.version = 4;
  t.category = "image";
  t.summary = "Makes a bent normal map from a height map";
  t.help =
      "Where the open sky lies: the mean of all directions in which a point sees the sky, by the same search for the "
      "horizon as \"make_occlusion\" (Landis 2002). Renderers look up ambient light there. It points straight up on "
      "flat ground, leans away from walls, and does not follow the surface's own slope as a normal map does.";
  t.inputs = {image_port("height", "the height map, 1 channel")};
  t.outputs = {
      image_port("normal", "unit vectors in tangent space, encoded as normals, in the height map's bit depth")};
  t.params = {
      height_scale_param(),
      horizon_radius_param(),
      {.name = "sky",
       .type = ParamType::choice,
       .fallback = "cosine",
       .help = "How directions count: cosine as light that falls on flat ground, uniform all alike, which bends "
               "more.",
       .choices = {"cosine", "uniform"}},
      derived_edges_param(),
      normal_y_param()};
  t.persist = Persist::payload;
  t.memory_hint = [](const NodeContext& node) {
    return size_t(node.input<Image>("height")->size().area()) * 3 * sizeof(float);
  };
  t.memory_ahead = [](const Params&, const InputForecasts& inputs) {
    return uint64_t(image_at(inputs, "height").size.value_or(Size{}).area()) * 3 * sizeof(float);
  };
  t.infer = infer_make_bent_normal;
  t.compute = compute_make_bent_normal;
  return t;
}

}  // namespace terrazzo
