#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/portable_math.h"
#include "nodes/common/node_helpers.h"

namespace terrazzo {

namespace {

/// How far along the gradient a pixel's centre lies, 0 to 1.
class Progress {
 public:
  Progress(Size size, bool radial, double angle)
      : radial_(radial), middle_x_(size.width / 2.0), middle_y_(size.height / 2.0) {
    cosine_ = portable::cos_turns(angle / 360);
    sine_ = portable::sin_turns(angle / 360);
    // Linear: corner to corner, so that every value appears. Radial: to the middle of the nearest side.
    length_ = radial ? std::min(middle_x_, middle_y_) : std::abs(cosine_) * size.width + std::abs(sine_) * size.height;
  }
  double at(int x, int y) const {
    const double dx = x + 0.5 - middle_x_, dy = y + 0.5 - middle_y_;
    const double far = radial_ ? std::sqrt(dx * dx + dy * dy) : cosine_ * dx - sine_ * dy + length_ / 2;
    return std::clamp(far / length_, 0.0, 1.0);
  }

 private:
  bool radial_;
  double middle_x_, middle_y_, cosine_, sine_, length_;
};

void compute_gradient(NodeContext& node) {
  const Numbers from = node.numbers("from"), to = node.numbers("to");
  const ImageInfo info = generated_info(node, int(from.size()));
  const Progress progress(info.size, node.text("shape") == "radial", node.number("angle"));
  node.output("image", Image::computed(info, node.key(), [=](const Rect& region, float* out) {
                for (int y = region.y; y < region.y + region.height; y++)
                  for (int x = region.x; x < region.x + region.width; x++) {
                    const double t = progress.at(x, y);
                    for (size_t c = 0; c < from.size(); c++) *out++ = float(from[c] + (to[c] - from[c]) * t);
                  }
              }));
}

std::vector<std::string> check_gradient(const Params& params) {
  const size_t from = std::get<Numbers>(params.at("from")).size(), to = std::get<Numbers>(params.at("to")).size();
  if (from == to) return {};
  return {fmt::format("\"to\": expected as many numbers as \"from\" has, {}; found {}", from, to)};
}

Param end(const std::string& name, double fallback, const std::string& help) {
  return {.name = name,
          .type = ParamType::numbers,
          .fallback = Numbers{fallback},
          .help = help,
          .min = 0,
          .max = 65504,
          .min_count = 1,
          .max_count = 4};
}

}  // namespace

NodeType gradient_node() {
  NodeType t;
  t.name = "gradient";
  t.category = "source";
  t.summary = "A ramp from one colour or value to another";
  t.help =
      "For masks that fade, for targets and guidance that say where, and for trying nodes out. Values change evenly; "
      "put \"curve\" behind it for another course. Pixels are computed on demand.";
  t.outputs = {image_port("image", "as many channels as from has numbers")};
  t.params = {end("from", 0,
                  "The value at the beginning: one number for grey, three for a colour, two or four with "
                  "alpha."),
              end("to", 1, "The value at the end, with as many numbers."),
              {.name = "shape",
               .type = ParamType::choice,
               .fallback = "linear",
               .help = "linear: across the whole image. radial: from its centre to the middle of the nearest side.",
               .choices = {"linear", "radial"}},
              {.name = "angle",
               .type = ParamType::number,
               .fallback = 0.0,
               .help = "Direction of a linear gradient: 0 to the right, 90 to the top.",
               .min = -360,
               .max = 360,
               .unit = "degrees"},
              generated_size_param(),
              generated_semantic_param("data")};
  t.persist = Persist::derived;
  t.check = check_gradient;
  t.infer = [](const Params& params, const InputForecasts&) {
    return forecast_of_generated(params, int(std::get<Numbers>(params.at("from")).size()));
  };
  t.compute = compute_gradient;
  return t;
}

}  // namespace terrazzo
