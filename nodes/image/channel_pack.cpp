#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/image/image_facts.h"
#include "core/image/image_ops.h"
#include "core/image_io/color.h"
#include "nodes/common/color_space.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

const std::vector<std::string> channel_names = {"r", "g", "b", "a"};

/// The source of one channel of the result.
struct Source {
  ImagePtr image;  ///< null: a constant
  int channel = 0;
  float constant = 0;
};

/// The channel of the connected image that goes to channel `name`.
int source_channel(const Params& params, const std::string& name, const ImageFacts& image) {
  const TextMap& from = std::get<TextMap>(params.at("from"));
  const auto given = from.find(name);
  if (given == from.end()) return 0;
  const auto at = std::find(channel_names.begin(), channel_names.end(), given->second);
  const int channel = int(at - channel_names.begin());
  if (channel < image.channels.value_or(4)) return channel;
  throw Error("from", fmt::format("expected for {} one of {}, the channels of the image connected to it, found \"{}\"",
                                  name, fmt::join(channel_names.begin(), channel_names.begin() + *image.channels, ", "),
                                  given->second));
}

void require_one_number_each(const NumberMap& fill) {
  for (const auto& [name, numbers] : fill)
    if (numbers.size() != 1)
      throw Error("fill", fmt::format("expected one number for {}, found {}", name, numbers.size()));
}

void require_any(bool connected) {
  if (!connected) throw Error("r", "expected an image on at least one of r, g, b and a, found none");
}

/// One per channel of the result; its last channel is the last one that is connected or filled.
std::vector<Source> sources_of(const NodeContext& node) {
  const NumberMap& fill = node.number_map("fill");
  std::vector<Source> sources;
  size_t used = 0;
  for (const std::string& name : channel_names) {
    Source source;
    source.image = node.optional_input<Image>(name);
    const auto constant = fill.find(name);
    if (source.image) source.channel = source_channel(node.params(), name, facts_of(source.image->info()));
    if (constant != fill.end()) source.constant = float(constant->second.front());
    sources.push_back(source);
    if (source.image || constant != fill.end()) used = sources.size();
  }
  sources.resize(used);
  return sources;
}

ImageInfo packed_info(const NodeContext& node, const std::vector<Source>& sources) {
  const Image* first = nullptr;
  ImageInfo info;
  for (const Source& s : sources) {
    const Image* image = s.image.get();
    if (!image) continue;
    if (!first) info = image->info();
    first = first ? first : image;
    info.depth = std::max(info.depth, image->info().depth);
  }
  info.channels = int(sources.size());
  info.semantic = *semantic_from(node.text("semantic"));
  info.color_space = color_space_of(node, "color_space");
  return info;
}

void compute_channel_pack(NodeContext& node) {
  const std::vector<Source> sources = sources_of(node);
  const ImageInfo info = packed_info(node, sources);
  std::vector<ImagePtr> images;
  for (const Source& s : sources)
    if (s.image) images.push_back(s.image);
  node.output("image", pixel_by_pixel(info, node.key(), images, [=](auto in, float* out, int64_t count) {
                size_t next = 0;
                for (size_t c = 0; c < sources.size(); c++) {
                  const Source& s = sources[c];
                  const float* pixels = s.image ? in[next++] : nullptr;
                  for (int64_t i = 0; i < count; i++)
                    out[i * info.channels + c] = pixels ? pixels[i * s.image->channels() + s.channel] : s.constant;
                }
              }));
}

OutputForecasts infer_channel_pack(const Params& params, const InputForecasts& inputs) {
  const NumberMap& fill = std::get<NumberMap>(params.at("fill"));
  check_all([&] { require_one_number_each(fill); }, [&] { require_any(!inputs.empty()); });
  ImageFacts first, out;
  for (size_t c = 0; c < channel_names.size(); c++) {
    const std::string& name = channel_names[c];
    if (const ImageFacts image = image_at(inputs, name); wires_at(inputs, name) > 0) {
      require_same_size(name, image, "the first image", first);
      source_channel(params, name, image);
      if (!first.size) first = image;
    }
    if (wires_at(inputs, name) > 0 || fill.contains(name)) out.channels = int(c) + 1;
  }
  out.size = first.size;
  out.semantic = semantic_from(std::get<std::string>(params.at("semantic")));
  return {{"image", forecast_of_image(out)}};
}

}  // namespace

NodeType channel_pack_node() {
  NodeType t;
  t.name = "channel_pack";
  t.category = "image";
  t.summary = "Puts channels of several images into one";
  t.help =
      "Occlusion, roughness and metallic on r, g and b make the ORM map that glTF and Unreal read. The result ends "
      "with the last channel that is connected or filled. All images need the same size. Values are taken as stored, "
      "at the greatest bit depth of the images.";
  for (const std::string& name : channel_names)
    t.inputs.push_back({.name = name,
                        .type = ValueType::image,
                        .help = "source of channel " + name + "; if not connected, fill",
                        .optional = true});
  t.outputs = {image_port("image", "1 to 4 channels")};
  t.params = {
      {.name = "from",
       .type = ParamType::text_map,
       .fallback = TextMap{},
       .help = "Which channel of each connected image to take, such as {\"g\": \"b\"}; the first (r) if not given.",
       .choices = channel_names},
      {.name = "fill",
       .type = ParamType::number_map,
       .fallback = NumberMap{},
       .help = "Values of channels that are not connected, such as {\"a\": 1}; 0 if not given.",
       .choices = channel_names},
      {.name = "semantic",
       .type = ParamType::choice,
       .fallback = "data",
       .help = "What the result is.",
       .choices = {semantic_names.begin(), semantic_names.end()}},
      {.name = "color_space",
       .type = ParamType::text,
       .fallback = "raw",
       .help = "The result's colour space, such as srgb_texture for 8-bit colours; nothing is converted."}};
  t.persist = Persist::derived;
  t.files_read = [](const Params&) { return color_config_files(); };
  t.check = [](const Params& p) { return color_space_problems(p, "color_space"); };
  t.compute = compute_channel_pack;
  t.infer = infer_channel_pack;
  return t;
}

}  // namespace terrazzo
