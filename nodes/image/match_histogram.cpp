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

void compute_match_histogram(NodeContext& node) {
  const ImagePtr image = node.input<Image>("image"), reference = node.input<Image>("reference");
  const ImageInfo info = image->info();
  const int channels = value_channels(info);
  const std::vector<Distribution> own = Distribution::of(*image, node.task()),
                                  wanted = Distribution::of(*reference, node.task());
  std::vector<PiecewiseLinear> curves;
  for (int c = 0; c < channels; c++) curves.push_back(matching_curve(own[c], wanted[c]));
  const double strength = node.number("strength");
  node.output("image", pixel_by_pixel(info, node.key(), {image}, [=](auto in, float* out, int64_t count) {
                for (int64_t i = 0; i < count; i++)
                  for (int c = 0; c < info.channels; c++) {
                    const float v = in[0][i * info.channels + c];
                    out[i * info.channels + c] = c < channels ? float(v + strength * (curves[c](v) - v)) : v;
                  }
                keep_in_range(info, out, count);
              }));
}

OutputForecasts infer_match_histogram(const Params& params, const InputForecasts& inputs) {
  const ImageFacts image = image_at(inputs, "image"), reference = image_at(inputs, "reference");
  require_no_normals("image", image);
  const std::optional<int> channels = value_channels(image), wanted = value_channels(reference);
  if (channels && wanted && *channels != *wanted)
    throw Error("reference", fmt::format("expected as many channels as \"image\", {}; found {}", describe(image),
                                         describe(reference)));
  return same_image_rule()(params, inputs);
}

}  // namespace

NodeType match_histogram_node() {
  NodeType t;
  t.name = "match_histogram";
  t.category = "image";
  t.summary = "Gives an image the distribution of another's values";
  t.help =
      "Each channel's values are mapped to the reference's values of equal rank (quantile mapping), so that both have "
      "the same histogram. Sizes may differ. Works on stored values and leaves alpha as it is.";
  t.inputs = {image_port("image", "the image to change; not a normal map"),
              image_port("reference", "the image with the wanted distribution; as many channels")};
  t.outputs = {image_port("image", "the changed image")};
  t.params = {{.name = "strength",
               .type = ParamType::number,
               .fallback = 1.0,
               .help = "0 leaves the image as it is, 1 gives it the reference's distribution.",
               .min = 0,
               .max = 1}};
  t.persist = Persist::digest;
  t.infer = infer_match_histogram;
  t.compute = compute_match_histogram;
  return t;
}

}  // namespace terrazzo
