#include <numeric>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image/image_facts.h"
#include "core/image/image_ops.h"
#include "core/image/pixel_space.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

std::vector<double> weights_of(const Params& params, int channels) {
  const std::string& method = std::get<std::string>(params.at("method"));
  if (method == "luminance" && channels == 3) return {0.2126, 0.7152, 0.0722};
  if (method != "weights") return std::vector<double>(channels, 1.0 / channels);
  const Numbers& weights = std::get<Numbers>(params.at("weights"));
  if (int(weights.size()) != channels)
    throw Error("weights", fmt::format("expected {}, one for each of the image's channels except alpha; found {}",
                                       counted(channels, "weight"), weights.size()));
  return weights;
}

void compute_grayscale(NodeContext& node) {
  const ImagePtr image = node.input<Image>("image");
  const ImageInfo from = image->info();
  const std::vector<double> weights = weights_of(node.params(), value_channels(from));
  ImageInfo info = from;
  info.channels = 1;
  node.output("image", pixel_by_pixel(info, node.key(), {image}, [=](auto in, float* out, int64_t count) {
                std::vector<float> linear(in[0], in[0] + count * from.channels);
                to_linear(from, linear.data(), count);
                for (int64_t i = 0; i < count; i++) {
                  const float* p = &linear[i * from.channels];
                  out[i] = float(std::inner_product(weights.begin(), weights.end(), p, 0.0));
                }
                to_stored(info, out, count);
              }));
}

OutputForecasts infer_grayscale(const Params& params, const InputForecasts& inputs) {
  ImageFacts image = image_at(inputs, "image");
  require_no_normals("image", image);
  if (const std::optional<int> channels = value_channels(image)) weights_of(params, *channels);
  image.channels = 1;
  return {{"image", forecast_of_image(image)}};
}

}  // namespace

NodeType grayscale_node() {
  NodeType t;
  t.name = "grayscale";
  t.category = "image";
  t.summary = "One channel out of several";
  t.help =
      "The weighted sum of the channels; colours stored as srgb_texture are summed in linear light and encoded again. "
      "Alpha is dropped. Semantic and colour space stay. To take one channel as it is, use \"channel_split\".";
  t.inputs = {image_port("image", "the image; not a normal map")};
  t.outputs = {image_port("image", "1 channel")};
  t.params = {
      {.name = "method",
       .type = ParamType::choice,
       .fallback = "luminance",
       .help =
           "luminance: Rec.709 weights for 3 channels, else the average. average: equal weights. weights: as given.",
       .choices = {"luminance", "average", "weights"}},
      {.name = "weights",
       .type = ParamType::numbers,
       .fallback = Numbers{1.0},
       .help = "With method weights: the factor of each channel.",
       .max_count = 4}};
  t.persist = Persist::derived;
  t.infer = infer_grayscale;
  t.compute = compute_grayscale;
  return t;
}

}  // namespace terrazzo
