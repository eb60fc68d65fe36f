#include <algorithm>

#include <fmt/format.h>

#include "core/image/distribution.h"
#include "core/image/image_facts.h"
#include "core/image/image_ops.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

float smooth_step(float t) {
  t = std::clamp(t, 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

void compute_threshold(NodeContext& node) {
  const ImagePtr image = node.input<Image>("image");
  double value = node.number("value");
  if (node.flag("auto")) {
    value = Distribution::of(*image, node.task()).front().otsu_threshold();
    node.note(fmt::format("threshold {:.6g}", value));
  }
  ImageInfo info = image->info();
  info.semantic = Semantic::mask;
  info.color_space = "raw";
  const float middle = float(value), softness = float(node.number("softness"));
  const bool inverted = node.flag("inverted");
  node.output("mask", pixel_by_pixel(info, node.key(), {image}, [=](auto in, float* out, int64_t count) {
                for (int64_t i = 0; i < count; i++) {
                  const float above = in[0][i] - middle;
                  const float inside = softness > 0 ? smooth_step(above / softness + 0.5f) : above >= 0 ? 1.0f : 0.0f;
                  out[i] = inverted ? 1 - inside : inside;
                }
              }));
}

OutputForecasts infer_threshold(const Params&, const InputForecasts& inputs) {
  ImageFacts image = image_at(inputs, "image");
  require_one_channel("image", image);
  return {{"mask", forecast_of_image({image.size, 1, Semantic::mask, "raw"})}};
}

}  // namespace

NodeType threshold_node() {
  NodeType t;
  t.name = "threshold";
  t.category = "image";
  t.summary = "Makes a mask of pixels above a value";
  t.help =
      "1 where the image is at or above the value, 0 below. The automatic value separates light from dark by the "
      "greatest variance between them (Otsu 1979); a note prints it.";
  t.inputs = {image_port("image", "the image, 1 channel")};
  t.outputs = {image_port("mask", "the mask, 1 channel")};
  t.params = {sample_param("value", 0.5, "Pixels at or above it are in the mask."),
              {.name = "auto",
               .type = ParamType::boolean,
               .fallback = false,
               .help = "Finds the value from the image and ignores \"value\"."},
              {.name = "softness",
               .type = ParamType::number,
               .fallback = 0.0,
               .help = "Width of the transition around the value, in the image's values; 0 for a hard edge.",
               .min = 0,
               .max = largest_sample},
              {.name = "inverted", .type = ParamType::boolean, .fallback = false, .help = "Swaps 0 and 1."}};
  t.persist = Persist::digest;
  t.infer = infer_threshold;
  t.compute = compute_threshold;
  return t;
}

}  // namespace terrazzo
