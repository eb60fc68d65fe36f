#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/portable_math.h"
#include "core/image/distribution.h"
#include "core/image/image_facts.h"
#include "core/image/image_ops.h"
#include "core/image/pixel_space.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

/// One channel's curve.
struct Level {
  double in_black, in_white, gamma, out_black, out_white;
  bool clamps;
  float operator()(float v) const {
    double t = (v - in_black) / (in_white - in_black);
    if (clamps) t = std::clamp(t, 0.0, 1.0);
    if (gamma != 1) t = std::copysign(portable::pow(std::fabs(t), 1 / gamma), t);
    return float(out_black + t * (out_white - out_black));
  }
};

std::vector<Level> given_levels(const NodeContext& node, int channels) {
  const std::vector<double> in_black = per_channel(node.params(), "in_black", channels),
                            in_white = per_channel(node.params(), "in_white", channels),
                            gamma = per_channel(node.params(), "gamma", channels),
                            out_black = per_channel(node.params(), "out_black", channels),
                            out_white = per_channel(node.params(), "out_white", channels);
  std::vector<Level> levels;
  for (int c = 0; c < channels; c++)
    levels.push_back({in_black[c], in_white[c], gamma[c], out_black[c], out_white[c], node.flag("clamp")});
  return levels;
}

/// Black and white points such that `clip` percent of the pixels lie beyond each.
void find_black_and_white(NodeContext& node, const Image& image, std::vector<Level>& levels) {
  std::vector<Distribution> channels = Distribution::of(image, node.task());
  channels.erase(channels.begin() + levels.size(), channels.end());
  if (node.text("auto") == "image") channels.assign(levels.size(), Distribution::merged(channels));
  const double clip = node.number("clip") / 100;
  for (size_t c = 0; c < levels.size(); c++) {
    levels[c].in_black = channels[c].quantile(clip);
    levels[c].in_white = channels[c].quantile(1 - clip);
    if (levels[c].in_black == levels[c].in_white) {
      node.note(fmt::format("channel {} has only one value, {}; its levels stay as they are", c, levels[c].in_black));
      levels[c] = {0, 1, 1, 0, 1, false};
    }
  }
}

void compute_levels(NodeContext& node) {
  const ImagePtr image = node.input<Image>("image");
  std::vector<Level> levels = given_levels(node, value_channels(image->info()));
  if (node.text("auto") != "off") find_black_and_white(node, *image, levels);
  for (size_t c = 0; c < levels.size(); c++)
    if (levels[c].in_black == levels[c].in_white)
      throw Error("in_white", fmt::format("expected a value other than in_black, found {} for both of channel {}",
                                          levels[c].in_white, c));
  const ImageInfo info = image->info();
  node.output("image", pixel_by_pixel(info, node.key(), {image}, [info, levels](auto in, float* out, int64_t count) {
                for (int64_t i = 0; i < count; i++)
                  for (int c = 0; c < info.channels; c++) {
                    const float v = in[0][i * info.channels + c];
                    out[i * info.channels + c] = c < int(levels.size()) ? levels[c](v) : v;
                  }
                keep_in_range(info, out, count);
              }));
}

OutputForecasts infer_levels(const Params& params, const InputForecasts& inputs) {
  const ImageFacts image = image_at(inputs, "image");
  require_no_normals("image", image);
  if (const std::optional<int> channels = value_channels(image))
    for (const char* param : {"in_black", "in_white", "gamma", "out_black", "out_white"})
      per_channel(params, param, *channels);
  return same_image_rule()(params, inputs);
}

Param level_param(const std::string& name, double fallback, const std::string& help) {
  return {.name = name,
          .type = ParamType::numbers,
          .fallback = Numbers{fallback},
          .help = help + " One number, or one per channel.",
          .min = -largest_sample,
          .max = largest_sample,
          .min_count = 1,
          .max_count = 4};
}

std::vector<std::string> check_levels(const Params& params) {
  const auto numbers = [&](const char* name) { return std::get<Numbers>(params.at(name)); };
  const Numbers black = numbers("in_black"), white = numbers("in_white");
  if (std::get<std::string>(params.at("auto")) != "off") return {};
  for (size_t c = 0; c < std::max(black.size(), white.size()); c++) {
    // The counts can only be checked with the image.
    const double b = black[std::min(c, black.size() - 1)], w = white[std::min(c, white.size() - 1)];
    if (b == w) return {fmt::format("\"in_white\": expected a value other than in_black, found {} for both", w)};
  }
  return {};
}

}  // namespace

NodeType levels_node() {
  NodeType t;
  t.name = "levels";
  t.version = 2;
  t.category = "image";
  t.summary = "Black point, white point and gamma; inverts, as gloss to roughness";
  t.help =
      "Maps [in_black, in_white] through a gamma to [out_black, out_white]. Works on stored values and leaves alpha as "
      "it is. The auto modes find in_black and in_white from the image. To invert a map, as gloss (smoothness) to "
      "roughness and back, set out_black to [1] and out_white to [0]: 8- and 16-bit values come back exactly.";
  t.inputs = {image_port("image", "the image; not a normal map")};
  t.outputs = {image_port("image", "the image with its levels changed")};
  Param gamma = level_param("gamma", 1, "Above 1 lightens the midtones, below 1 darkens them.");
  gamma.min = 0.01;
  gamma.max = 100;
  t.params = {
      level_param("in_black", 0, "The value that becomes out_black."),
      level_param("in_white", 1, "The value that becomes out_white."),
      gamma,
      level_param("out_black", 0, "What in_black becomes."),
      level_param("out_white", 1, "What in_white becomes."),
      {.name = "auto",
       .type = ParamType::choice,
       .fallback = "off",
       .help = "Finds in_black and in_white: the same for all channels (image), or each channel's own (channel).",
       .choices = {"off", "image", "channel"}},
      {.name = "clip",
       .type = ParamType::number,
       .fallback = 0.1,
       .help = "In the auto modes: share of pixels clipped at black, and at white. More gives more contrast.",
       .min = 0,
       .max = 49,
       .unit = "percent"},
      {.name = "clamp",
       .type = ParamType::boolean,
       .fallback = true,
       .help = "Keeps values within [out_black, out_white]. 8- and 16-bit maps stay within [0, 1] anyway."}};
  t.persist = Persist::digest;
  t.check = check_levels;
  t.infer = infer_levels;
  t.compute = compute_levels;
  return t;
}

}  // namespace terrazzo
