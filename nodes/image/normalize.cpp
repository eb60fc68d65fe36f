#include <fmt/format.h>

#include "core/base/error.h"
#include "core/image/distribution.h"
#include "core/image/image_facts.h"
#include "core/image/image_ops.h"
#include "core/image/pixel_space.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

/// The mapping of a channel: v * factor + offset.
struct Line {
  double factor = 1;
  double offset = 0;
};

Line to_range(const Distribution& d, double low, double high) {
  if (d.min() == d.max()) return {0, 0.5 * (low + high)};
  const double factor = (high - low) / (double(d.max()) - d.min());
  return {factor, low - d.min() * factor};
}

Line to_statistics(const Distribution& d, double mean, double deviation) {
  const double own = d.deviation();
  const double factor = own > 0 ? deviation / own : 0;
  return {factor, mean - d.mean() * factor};
}

std::vector<Line> lines_of(NodeContext& node, const Image& image) {
  std::vector<Distribution> channels = Distribution::of(image, node.task());
  channels.erase(channels.begin() + value_channels(image.info()), channels.end());
  if (node.flag("together")) channels.assign(channels.size(), Distribution::merged(channels));
  std::vector<Line> lines;
  for (const Distribution& d : channels)
    lines.push_back(node.text("mode") == "statistics" ? to_statistics(d, node.number("mean"), node.number("deviation"))
                                                      : to_range(d, node.number("low"), node.number("high")));
  return lines;
}

ImagePtr normalized_values(NodeContext& node, const ImagePtr& image) {
  const std::vector<Line> lines = lines_of(node, *image);
  const ImageInfo info = image->info();
  return pixel_by_pixel(info, node.key(), {image}, [info, lines](auto in, float* out, int64_t count) {
    for (int64_t i = 0; i < count; i++)
      for (int c = 0; c < info.channels; c++) {
        const float v = in[0][i * info.channels + c];
        out[i * info.channels + c] = c < int(lines.size()) ? float(v * lines[c].factor + lines[c].offset) : v;
      }
    keep_in_range(info, out, count);
  });
}

ImagePtr unit_vectors(const NodeContext& node, const ImagePtr& image) {
  const ImageInfo info = image->info();
  return pixel_by_pixel(info, node.key(), {image}, [info](auto in, float* out, int64_t count) {
    std::copy_n(in[0], count * info.channels, out);
    to_stored(info, out, count);
  });
}

void compute_normalize(NodeContext& node) {
  const ImagePtr image = node.input<Image>("image");
  node.output("image",
              image->info().semantic == Semantic::normal ? unit_vectors(node, image) : normalized_values(node, image));
}

OutputForecasts infer_normalize(const Params& params, const InputForecasts& inputs) {
  const ImageFacts image = image_at(inputs, "image");
  if (image.semantic == Semantic::normal && image.channels.value_or(3) < 3)
    throw Error("image", fmt::format("expected normals of 3 channels, found {}", describe(image)));
  return same_image_rule()(params, inputs);
}

}  // namespace

NodeType normalize_node() {
  NodeType t;
  t.name = "normalize";
  t.category = "image";
  t.summary = "Brings an image to a given range or mean and deviation";
  t.help =
      "Stretches the values linearly to a range, or to a mean and standard deviation; a constant image gets the middle "
      "or the mean. Alpha stays as it is. Normal maps are different: every vector is made unit length, and the "
      "parameters are ignored.";
  t.inputs = {image_port("image", "the image")};
  t.outputs = {image_port("image", "the normalised image")};
  t.params = {{.name = "mode",
               .type = ParamType::choice,
               .fallback = "range",
               .help = "range: the smallest value becomes low, the largest high. statistics: mean and deviation.",
               .choices = {"range", "statistics"}},
              sample_param("low", 0, "With mode range: the smallest value."),
              sample_param("high", 1, "With mode range: the largest value."),
              sample_param("mean", 0.5, "With mode statistics: the mean."),
              {.name = "deviation",
               .type = ParamType::number,
               .fallback = 0.2,
               .help = "With mode statistics: the standard deviation. 8- and 16-bit maps are then clamped to [0, 1].",
               .min = 0,
               .max = largest_sample},
              {.name = "together",
               .type = ParamType::boolean,
               .fallback = true,
               .help = "One stretch for all channels, which keeps hues; false stretches each channel by itself."}};
  t.persist = Persist::digest;
  t.infer = infer_normalize;
  t.compute = compute_normalize;
  return t;
}

}  // namespace terrazzo
