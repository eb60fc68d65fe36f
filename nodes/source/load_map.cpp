#include <fmt/format.h>

#include "core/image/color.h"
#include "core/image/image_file.h"
#include "core/image/image_limits.h"
#include "core/image/image_ops.h"
#include "core/node/node.h"
#include "nodes/common/color_space.h"
#include "nodes/common/exemplar_doubts.h"
#include "nodes/common/node_helpers.h"

namespace terrazzo {

namespace {

/// A mask painted as transparency would silently be all white or all black.
void note_transparency(NodeContext& node, const Image& mask) {
  const int channels = mask.channels();
  if (channels != 2 && channels != 4) return;
  bool transparent = false;
  for_each_strip(mask, [&](const Rect& r, const float* v) {
    for (int64_t i = 0; i < r.area() && !transparent; i++) transparent = v[(i + 1) * channels - 1] < 1;
  });
  if (transparent)
    node.warn(fmt::format(
        "only the mask's first channel counts, not its alpha; to use alpha, take output \"{}\" of channel_split",
        channels == 2 ? "g" : "a"));
}

void compute(NodeContext& node) {
  ImageInfo info;
  info.semantic = *semantic_from(node.text("semantic"));
  info.normal_y = node.text("normal_y") == "down" ? NormalY::down : NormalY::up;
  const std::string &path = node.text("path"), &layer = node.text("layer");
  info.color_space = node.text("color_space") == "auto"
                         ? assumed_color_space(info.semantic, read_image_info(path, layer).depth)
                         : color_space_of(node, "color_space");
  const ImagePtr image = read_image(
      path, info, [&](const std::string& warning) { node.note(warning); }, layer);
  if (info.semantic == Semantic::mask) note_transparency(node, *image);
  node.output("image", image);
}

}  // namespace

NodeType load_map_node() {
  NodeType t;
  t.name = "load_map";
  t.version = 2;
  t.category = "source";
  t.summary = "Reads one image file as a map";
  t.help =
      "Reads PNG, TIFF, EXR, JPEG and everything else OpenImageIO reads. Pixel values are not changed, except that "
      "signed normals are encoded to 0..1 and NaN or infinite values become 0. Semantic, colour space and normal "
      "convention tell later nodes how to interpret them.";
  t.outputs = {{.name = "image", .type = ValueType::image, .help = "the map"}};
  t.params = {
      {.name = "path", .type = ParamType::path, .help = "The image file."},
      {.name = "layer",
       .type = ParamType::text,
       .fallback = "",
       .help =
           "Which layer of an EXR file that holds several: a part's name, or what stands before the last dot of its "
           "channels' names. Empty: the channels without a layer, or the only layer."},
      {.name = "semantic",
       .type = ParamType::choice,
       .fallback = "base_color",
       .help = "What the map is; decides how it is weighted, filtered and written.",
       .choices = semantic_choices()},
      {.name = "color_space",
       .type = ParamType::text,
       .fallback = "auto",
       .help = "The file's colour space. \"auto\": srgb_texture for colours in 8 and 16 bit, lin_rec709 for colours in "
               "float files, raw for everything else."},
      {.name = "normal_y",
       .type = ParamType::choice,
       .fallback = "up",
       .help = "Green channel of a normal map: up as in OpenGL, down as in DirectX.",
       .choices = {"up", "down"}},
  };
  t.persist = Persist::digest;
  t.files_read = [](const Params& p) {
    std::vector<std::filesystem::path> files = {std::get<std::string>(p.at("path"))};
    for (std::filesystem::path& f : color_config_files()) files.push_back(std::move(f));
    return files;
  };
  t.memory_hint = [](const NodeContext& node) {
    try {
      const FileInfo info = read_image_info(node.text("path"), node.text("layer"));
      return size_t(info.size.area()) * info.channels * 2 * sizeof(float);
    } catch (const Error&) {
      return size_t{0};  // compute reports it
    }
  };
  t.check = [](const Params& p) { return color_space_problems(p, "color_space", "auto"); };
  t.preflight = [](const Params& p, const InputForecasts&) {
    const std::string& path = std::get<std::string>(p.at("path"));
    require_readable_image(path);
    Forecast out;
    ImageFacts& image = out.images[""];
    image.semantic = semantic_from(std::get<std::string>(p.at("semantic")));
    try {
      const FileInfo file = read_image_info(path, std::get<std::string>(p.at("layer")));
      image.size = file.size;
      image.channels = file.channels;
    } catch (const TooManyPixels&) {
      throw;
    } catch (const Error&) {
      // compute reports it
    }
    return out;
  };
  t.doubts = [](const Params& p, const InputForecasts&) {
    const bool is_colour = std::get<std::string>(p.at("semantic")) == "base_color";
    return is_colour ? doubts_about_colour("\"path\"", std::get<std::string>(p.at("path"))) : Texts{};
  };
  t.compute = compute;
  return t;
}

}  // namespace terrazzo
