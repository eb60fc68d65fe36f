#include "core/image/image_facts.h"
#include "core/image/normal.h"
#include "nodes/common/derived_edges.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

void compute_make_normal(NodeContext& node) {
  const ImagePtr height = node.input<Image>("height");
  ImageInfo info = height->info();
  info.channels = 3;
  info.semantic = Semantic::normal;
  info.color_space = "raw";
  info.normal_y = normal_y_of(node);
  const double scale = node.number("height_scale");
  const SlopeFilter filter = *slope_filter_from(node.text("filter"));
  const Outside outside = derived_edges_of(node, height);
  Operation operation{.sources = {height}, .compute = {}, .work = 10};
  operation.reads = [=, size = info.size](size_t, const Rect& region) {
    return padded_parts(size, grown(region, slope_reach), outside);
  };
  operation.compute = [=](std::span<const PixelView> in, const Rect& region, float* out) {
    normals_from_height(in[0], region, scale, filter, outside, info.normal_y, out);
  };
  const ImagePtr normal = Image::computed(info, node.key(), std::move(operation));
  know_edges(normal, outside);
  node.output("normal", normal);
}

OutputForecasts infer_make_normal(const Params&, const InputForecasts& inputs) {
  const ImageFacts height = image_at(inputs, "height");
  require_one_channel("height", height);
  return {{"normal", forecast_of_image({height.size, 3, Semantic::normal, "raw"})}};
}

}  // namespace

NodeType make_normal_node() {
  NodeType t;
  t.name = "make_normal";
  t.version = 4;
  t.category = "image";
  t.summary = "Makes a normal map from a height map";
  t.help =
      "Normals come from the slopes between a pixel's neighbours: n = (-dh/dx, -dh/dy, 1), made unit length. Pixels "
      "are computed on demand.";
  t.inputs = {image_port("height", "the height map, 1 channel")};
  t.outputs = {image_port("normal", "tangent-space normals, in the height map's bit depth")};
  t.params = {height_scale_param(),
              {.name = "filter",
               .type = ParamType::choice,
               .fallback = "scharr",
               .help = "How slopes are measured: over 3x3 pixels (sobel, or scharr, which treats directions most "
                       "alike), or between the two neighbours (central, the sharpest).",
               .choices = {"scharr", "sobel", "central"}},
              derived_edges_param(),
              normal_y_param()};
  t.persist = Persist::derived;
  t.infer = infer_make_normal;
  t.compute = compute_make_normal;
  return t;
}

}  // namespace terrazzo
