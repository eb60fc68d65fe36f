#include "core/image/image_ops.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

constexpr std::array<const char*, 4> part_names = {"r", "g", "b", "a"};

ImagePtr one_channel(const NodeContext& node, const ImagePtr& image, int channel) {
  ImageInfo info = image->info();
  const int channels = info.channels;
  const float missing = channel == 3 ? 1.0f : 0.0f;
  info.channels = 1;
  info.semantic = Semantic::data;
  info.color_space = "raw";
  Hasher recipe;
  recipe.add(node.key()).add(channel);
  return pixel_by_pixel(info, recipe.digest(), {image}, [=](auto in, float* out, int64_t count) {
    for (int64_t i = 0; i < count; i++) out[i] = channel < channels ? in[0][i * channels + channel] : missing;
  });
}

void compute_channel_split(NodeContext& node) {
  const ImagePtr image = node.input<Image>("image");
  for (int c = 0; c < 4; c++) node.output(part_names[c], one_channel(node, image, c));
}

}  // namespace

NodeType channel_split_node() {
  NodeType t;
  t.name = "channel_split";
  t.category = "image";
  t.summary = "Splits an image into its channels";
  t.help =
      "Values stay as stored. Each output is raw data (say what it is with \"make_material\"). A missing channel is 0, "
      "a missing alpha 1 (opaque).";
  t.inputs = {image_port("image", "1 to 4 channels")};
  t.outputs = {image_port("r", "first channel"), image_port("g", "second channel, or 0"),
               image_port("b", "third channel, or 0"), image_port("a", "fourth channel, or 1")};
  t.persist = Persist::derived;
  t.infer = [](const Params&, const InputForecasts& inputs) {
    OutputForecasts out;
    for (const char* name : part_names)
      out[name] = forecast_of_image({image_at(inputs, "image").size, 1, Semantic::data, "raw"});
    return out;
  };
  t.compute = compute_channel_split;
  return t;
}

}  // namespace terrazzo
