#include <algorithm>
#include <cmath>
#include <limits>

#include "core/image/image_facts.h"
#include "core/numeric/distance_transform.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

std::vector<uint8_t> set_pixels(const Image& mask, float threshold) {
  std::vector<uint8_t> out(size_t(mask.size().area()));
  for_each_strip(mask, [&](const Rect& strip, const float* v) {
    uint8_t* row = &out[size_t(strip.y) * size_t(mask.width())];
    for (int64_t i = 0; i < strip.area(); i++) row[i] = v[i] >= threshold;
  });
  return out;
}

std::vector<float> distances(const std::vector<uint8_t>& set, Size size, bool wraps, bool is_signed, float limit) {
  if (is_signed) return signed_distances(set, size, wraps, limit);
  std::vector<float> out;
  for (const int64_t squared : squared_distances(set, size, wraps))
    out.push_back(std::min(limit, float(std::sqrt(double(squared)))));
  return out;
}

void compute_distance(NodeContext& node) {
  const ImagePtr mask = node.input<Image>("mask");
  const std::vector<uint8_t> set = set_pixels(*mask, float(node.number("threshold")));
  if (std::find(set.begin(), set.end(), 1) == set.end())
    node.note(
        "no pixel is at or above the threshold, so all get the greatest distance; lower \"threshold\" or check the "
        "mask");
  const double limit = node.number("limit");
  const float most = limit > 0 ? float(limit) : std::numeric_limits<float>::max();
  std::vector<float> out = distances(set, mask->size(), edges_of(node) == Outside::wrap, node.flag("signed"), most);
  if (node.flag("normalized")) {
    float unit = float(limit);
    if (!(limit > 0))
      for (const float v : out) unit = std::max(unit, std::fabs(v));
    if (unit > 0)
      for (float& v : out) v /= unit;
  }
  const ImageInfo info{.size = mask->size(), .channels = 1, .semantic = Semantic::guidance};
  node.output("distance", Image::from_floats(info, std::move(out)));
}

OutputForecasts infer_distance(const Params&, const InputForecasts& inputs) {
  const ImageFacts mask = image_at(inputs, "mask");
  require_one_channel("mask", mask);
  return {{"distance", forecast_of_image(values_facts(mask.size, Semantic::guidance))}};
}

}  // namespace

NodeType distance_node() {
  NodeType t;
  t.name = "distance";
  t.category = "analysis";
  t.summary = "Distance to the marked pixels of a mask";
  t.help =
      "The exact Euclidean distance from every pixel to the nearest set pixel (Meijster, Roerdink & Hesselink 2000); "
      "signed, the distance to the outline, negative inside. Connect it to pca as guidance, or through \"levels\" to "
      "make rims, wear and contact shadows. \"guidance\" computes it from edges that it detects.";
  t.inputs = {image_port("mask", "1 channel; pixels at or above the threshold are set")};
  t.outputs = {image_port("distance", "1 channel: 0 on set pixels; signed, 0 on their outline and negative inside")};
  t.params = {
      {.name = "threshold", .type = ParamType::number, .fallback = 0.5, .help = "Pixels at or above it are set."},
      {.name = "signed",
       .type = ParamType::boolean,
       .fallback = false,
       .help = "Measures inside too: to the outline, half a pixel before the nearest pixel of the other kind."},
      {.name = "limit",
       .type = ParamType::number,
       .fallback = 0.0,
       .help = "Distances are limited to this; 0 for no limit.",
       .min = 0,
       .max = 131072,
       .unit = "pixels"},
      {.name = "normalized",
       .type = ParamType::boolean,
       .fallback = false,
       .help = "Divides by the limit, or without one by the greatest distance: 0..1, or -1..1 if signed. false gives "
               "pixels."},
      edges_param()};
  t.memory_hint = [](const NodeContext& node) { return size_t(node.input<Image>("mask")->size().area()) * 32; };
  t.infer = infer_distance;
  t.compute = compute_distance;
  return t;
}

}  // namespace terrazzo
