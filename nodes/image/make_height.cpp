#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/filter/height_from_normals.h"
#include "core/image/image_facts.h"
#include "nodes/common/derived_edges.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

/// A surface in pixels as values of a height map, in place.
void to_range(NodeContext& node, std::vector<float>& heights) {
  const double scale = node.number("height_scale");
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  const double lowest = *low, highest = *high, rise = highest - lowest;
  const std::string& range = node.text("range");
  node.note(fmt::format("the surface is {:.4g} pixels tall{}", rise,
                        range == "normalized" ? ", which is the height_scale of this map" : ""));
  double unit = scale, zero = -scale / 2;
  if (range == "normalized") {
    unit = std::copysign(rise > 0 ? rise : 1, scale);
    zero = scale > 0 ? lowest : highest;
  } else if (range == "from_zero") {
    zero = scale > 0 ? lowest : highest;
  }
  for (float& h : heights) h = float((h - zero) / unit);
}

/// Maps of 8 and 16 bit hold 0..1.
void clip(NodeContext& node, std::vector<float>& heights) {
  const auto lies_outside = [](float h) { return h < 0 || h > 1; };
  const auto clipped = std::count_if(heights.begin(), heights.end(), lies_outside);
  for (float& h : heights) h = std::clamp(h, 0.0f, 1.0f);
  if (clipped > 0)
    node.warn(
        fmt::format("{:.2g} % of the surface lies outside 0..1 and is cut off; raise \"height_scale\", or set "
                    "\"range\" to normalized",
                    100 * double(clipped) / double(heights.size())));
}

/// Whether the whole surface is tilted: then opposite borders have different heights although their normals agree. Less
/// than a tenth is due to rounding, or to the levelling of a scan.
bool leans(const Image& normal) {
  double x = 0, y = 0;
  for_each_strip(normal, [&](const Rect& strip, const float* v) {
    for (int64_t i = 0; i < strip.area(); i++, v += normal.channels()) {
      x += double(v[0]) * 2 - 1;
      y += double(v[1]) * 2 - 1;
    }
  });
  const double limit = 0.1 * double(normal.size().area());
  return std::abs(x) > limit || std::abs(y) > limit;
}

void compute_make_height(NodeContext& node) {
  const ImagePtr normal = node.input<Image>("normal");
  const IntegrationOptions options{
      .filter = slope_filter_from(node.text("filter")),
      .outside = node.text("edges") == "auto" && leans(*normal) ? Outside::clamp : derived_edges_of(node, normal),
      .flatten = node.number("flatten")};
  std::vector<float> heights = heights_from_normals(*normal, options, node.task());
  to_range(node, heights);
  ImageInfo info = normal->info();
  info.channels = 1;
  info.semantic = Semantic::height;
  info.normal_y = NormalY::up;
  if (info.depth == Depth::u8) info.depth = Depth::u16;  // 256 steps would show as terraces
  if (info.depth == Depth::u16) clip(node, heights);
  node.output("height", Image::from_floats(info, std::move(heights)));
}

OutputForecasts infer_make_height(const Params&, const InputForecasts& inputs) {
  const ImageFacts normal = image_at(inputs, "normal");
  require_normals("normal", normal);
  return {{"height", forecast_of_image({normal.size, 1, Semantic::height, normal.color_space})}};
}

std::vector<std::string> check_make_height(const Params& params) {
  if (std::get<double>(params.at("height_scale")) != 0) return {};
  return {"\"height_scale\": expected a number other than 0, found 0; any surface would be flat"};
}

}  // namespace

NodeType make_height_node() {
  NodeType t;
  t.name = "make_height";
  t.version = 4;
  t.category = "image";
  t.summary = "Makes a height map from a normal map";
  t.help =
      "Finds the surface whose slopes come nearest to the normals', by least squares: a Poisson equation, solved by "
      "multigrid (Simchony, Chellappa and Shao 1990). It is the way back from \"make_normal\": with the same "
      "height_scale, filter and edges it gives the height map again, but for a constant. Normals say nothing of height "
      "itself, and little of what is much wider than their relief: \"flatten\" levels out slow bends that come from "
      "rounded normals. Results have at least 16 bits.";
  t.inputs = {image_port("normal", "the normal map, 3 channels")};
  t.outputs = {image_port("height", "the height map, 1 channel")};
  Param edges = derived_edges_param();
  edges.help =
      "Whether the map tiles: wrap makes opposite borders meet, clamp lets each end where it will. auto wraps if "
      "opposite borders of the normals fit together, and says so.";
  t.params = {height_scale_param(),
              {.name = "range",
               .type = ParamType::choice,
               .fallback = "centered",
               .help = "Where heights lie: centered around 0.5, from_zero upwards from 0, both in units of "
                       "height_scale; or normalized, stretched from 0 to 1, with a note of the height_scale that this "
                       "is.",
               .choices = {"centered", "from_zero", "normalized"}},
              {.name = "filter",
               .type = ParamType::choice,
               .fallback = "scharr",
               .help = "How the normals were measured: with that filter of make_normal, or exact at every pixel, as "
                       "they are baked from geometry.",
               .choices = {"scharr", "sobel", "central", "exact"}},
              {.name = "flatten",
               .type = ParamType::number,
               .fallback = 0.0,
               .help = "Levels out what is much wider than this; less is flatter, 0 keeps everything.",
               .min = 0,
               .max = 100000,
               .unit = "pixels"},
              edges};
  t.persist = Persist::payload;
  t.memory_hint = [](const NodeContext& node) {
    return size_t(node.input<Image>("normal")->size().area()) * 5 * sizeof(float);
  };
  t.check = check_make_height;
  t.infer = infer_make_height;
  t.compute = compute_make_height;
  return t;
}

}  // namespace terrazzo
