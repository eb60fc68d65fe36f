#include "core/filter/curve.h"

#include <fmt/format.h>

#include "core/image/image_facts.h"
#include "core/image/image_ops.h"
#include "core/image/pixel_space.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

std::vector<std::pair<double, double>> points_of(const Params& params) {
  const Numbers& numbers = std::get<Numbers>(params.at("points"));
  std::vector<std::pair<double, double>> out;
  for (size_t i = 0; i + 1 < numbers.size(); i += 2) out.emplace_back(numbers[i], numbers[i + 1]);
  return out;
}

void compute_curve(NodeContext& node) {
  const ImagePtr image = node.input<Image>("image");
  const ImageInfo info = image->info();
  const int channels = info.channels, values = value_channels(info);
  const Curve curve(points_of(node.params()), node.text("interpolation") == "smooth");
  node.output("image", pixel_by_pixel(info, node.key(), {image}, [=](auto in, float* out, int64_t count) {
                for (int64_t i = 0; i < count * channels; i++)
                  out[i] = i % channels < values ? float(curve.at(in[0][i])) : in[0][i];
              }));
}

OutputForecasts infer_curve(const Params& params, const InputForecasts& inputs) {
  require_no_normals("image", image_at(inputs, "image"));
  return same_image_rule()(params, inputs);
}

std::vector<std::string> check_curve(const Params& params) {
  const size_t count = std::get<Numbers>(params.at("points")).size();
  if (count % 2 != 0) return {fmt::format("\"points\": expected pairs of numbers, x and y; found {} numbers", count)};
  const auto points = points_of(params);
  for (size_t i = 1; i < points.size(); i++)
    if (points[i].first <= points[i - 1].first)
      return {fmt::format("\"points\": expected each x above the one before; found {} after {}", points[i].first,
                          points[i - 1].first)};
  return {};
}

}  // namespace

NodeType curve_node() {
  NodeType t;
  t.name = "curve";
  t.category = "image";
  t.summary = "Remaps values by a curve through points";
  t.help =
      "Every channel but alpha, as stored. For contrast that \"levels\" cannot make: an S-curve, a band of heights cut "
      "out as a mask, roughness that rises late. The smooth curve (Fritsch & Butland 1984) never overshoots its "
      "points.";
  t.inputs = {image_port("image", "the image; not a normal map")};
  t.outputs = {image_port("image", "like the input")};
  t.params = {{.name = "points",
               .type = ParamType::numbers,
               .fallback = Numbers{0, 0, 1, 1},
               .help = "Where the curve goes through: x0, y0, x1, y1, ... with x ascending. Values beyond the ends get "
                       "the ends' y.",
               .min_count = 2,
               .max_count = 64},
              {.name = "interpolation",
               .type = ParamType::choice,
               .fallback = "smooth",
               .help = "smooth: a cubic curve. linear: straight lines from point to point.",
               .choices = {"smooth", "linear"}}};
  t.persist = Persist::derived;
  t.check = check_curve;
  t.infer = infer_curve;
  t.compute = compute_curve;
  return t;
}

}  // namespace terrazzo
