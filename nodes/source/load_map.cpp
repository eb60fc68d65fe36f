#include <fmt/format.h>

#include "core/image/image_facts.h"
#include "core/image/image_limits.h"
#include "core/image/image_ops.h"
#include "core/image/pixel_space.h"
#include "core/image_io/color.h"
#include "core/image_io/image_file.h"
#include "core/material/map_description.h"
#include "core/naming/interpretation.h"
#include "core/node/node.h"
#include "nodes/common/color_space.h"
#include "nodes/common/exemplar_lint.h"
#include "nodes/common/node_helpers.h"
#include "nodes/source/maps/depth_checks.h"
#include "nodes/source/maps/normal_maps.h"

namespace terrazzo {

namespace {

/// A mask or opacity map painted as transparency would otherwise silently become all white or all black.
void note_transparency(NodeContext& node, const Image& mask) {
  const int channels = mask.channels();
  if (channels != 2 && channels != 4) return;
  bool transparent = false;
  for_each_strip(mask, [&](const Rect& r, const float* v) {
    for (int64_t i = 0; i < r.area() && !transparent; i++) transparent = v[(i + 1) * channels - 1] < 1;
  });
  if (transparent)
    node.warn(fmt::format(
        "only the {}'s first channel counts, not its alpha; to use alpha, take output \"{}\" of channel_split",
        mask.info().semantic == Semantic::mask ? "mask" : "map", channels == 2 ? "g" : "a"));
}

/// The value of the parameter `interpret`. Throws Error.
Interpretation interpretation_in(const Params& params) {
  const std::string& words = std::get<std::string>(params.at("interpret"));
  if (words.empty()) return {};
  return interpretation_from(words, *semantic_from(std::get<std::string>(params.at("semantic"))));
}

ImagePtr inverted(const ImagePtr& image) {
  const ImageInfo info = image->info();
  const int values = value_channels(info);
  return pixel_by_pixel(info, Hasher().add("inverted").add(image->digest()).digest(), {image},
                        [info, values](auto in, float* out, int64_t count) {
                          for (int64_t i = 0; i < count * info.channels; i++)
                            out[i] = i % info.channels < values ? 1 - in[0][i] : in[0][i];
                        });
}

/// Converts the image according to the user's interpretation and, for normals, the pixels.
ImagePtr interpreted(NodeContext& node, const ImagePtr& image, const Interpretation& given) {
  const std::filesystem::path path = node.text("path");
  const std::string name = path.filename().string();
  const Semantic semantic = image->info().semantic;
  if (semantic == Semantic::normal) {
    std::vector<std::string> notes;
    const std::vector<std::string> channels = read_image_info(path, node.text("layer")).channel_names;
    const ImagePtr rebuilt =
        rebuilt_normals(image, {.place = name, .names = channels, .channels = given.normal}, nullptr, notes).image;
    for (std::string& n : notes) node.note(std::move(n));
    return rebuilt ? rebuilt : image;
  }
  if (given.inverted.value_or(false)) return inverted(image);
  if (semantic == Semantic::height && !given.inverted && is_depth(name, node.text("layer")))
    node.note(note_on_depth(name, ""));
  return image;
}

/// The colour space that the file states, else the default.
std::string space_of_file(NodeContext& node, const std::filesystem::path& path, const std::string& layer,
                          Semantic semantic) {
  const FileInfo file = read_image_info(path, layer);
  const std::string usual = assumed_color_space(semantic, file.depth), stated = stated_color_space(file, semantic);
  if (stated.empty() || stated == usual) return usual;
  node.note(fmt::format("{}: read as {}, as it says", path.filename().string(), stated));
  return stated;
}

void compute_load_map(NodeContext& node) {
  ImageInfo info;
  info.semantic = *semantic_from(node.text("semantic"));
  info.normal_y = node.text("normal_y") == "down" ? NormalY::down : NormalY::up;
  const std::string &path = node.text("path"), &layer = node.text("layer");
  info.color_space = node.text("color_space") == "auto" ? space_of_file(node, path, layer, info.semantic)
                                                        : color_space_of(node, "color_space");
  const Interpretation given = interpretation_in(node.params());
  const ImagePtr read = read_image(
      path, info, [&](const std::string& warning) { node.note(warning); }, layer, given.as_stored.value_or(false));
  const ImagePtr image = interpreted(node, read, given);
  if (info.semantic == Semantic::mask || info.semantic == Semantic::opacity) note_transparency(node, *image);
  node.output("image", image);
}

}  // namespace

NodeType load_map_node() {
  NodeType t;
  t.name = "load_map";
  t.version = 3;
  t.category = "source";
  t.summary = "Reads one image file as a map";
  t.help =
      "Reads PNG, TIFF, EXR, JPEG and everything else OpenImageIO reads. Pixel values are not changed, except that "
      "signed normals are encoded to 0..1, normals without z, as BC5 and DXT5nm store them, get it from x and y, "
      "colours that the file says are multiplied by alpha are divided by it, alpha "
      "of colours that is 0 everywhere becomes 1, and a few NaN or infinite values take the mean of their neighbours. "
      "CMYK and Lab, 32-bit integers that seem to be ids, and EXR data windows that leave parts without data are "
      "refused. Semantic, colour space and normal "
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
       .help = "The file's colour space. \"auto\": as the description that terrazzo writes into files says, or a PNG "
               "file's gAMA chunk that says linear; else srgb_texture for colours in 8 and 16 bit, lin_rec709 for "
               "colours in "
               "float files, raw for everything else."},
      {.name = "normal_y",
       .type = ParamType::choice,
       .fallback = "up",
       .help = "Green channel of a normal map: up as in OpenGL, down as in DirectX.",
       .choices = {"up", "down"}},
      {.name = "interpret",
       .type = ParamType::text,
       .fallback = "",
       .help = "What the file holds, where neither its name nor its pixels say it. " +
               std::string(interpretation_help) + ". Empty: nothing is said."},
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
  t.check = [](const Params& p) {
    Texts problems = color_space_problems(p, "color_space", "auto");
    try {
      interpretation_in(p);
    } catch (const Error& e) {
      problems.push_back(fmt::format("\"interpret\": {}", e.what()));
    }
    return problems;
  };
  t.preflight = [](const Params& p, const InputForecasts&) {
    const std::string& path = std::get<std::string>(p.at("path"));
    require_readable_image(path);
    Forecast out;
    ImageFacts& image = out.images[""];
    image.semantic = semantic_from(std::get<std::string>(p.at("semantic")));
    int channels = 0;
    try {
      const FileInfo file = read_image_info(path, std::get<std::string>(p.at("layer")));
      channels = file.channels;
      const bool is_turned = file.orientation >= 5 && interpretation_in(p).as_stored.value_or(false);
      image.size = is_turned ? Size{file.size.height, file.size.width} : file.size;
      if (image.semantic != Semantic::normal || file.channels == 3)
        image.channels = file.channels;
      else if (file.channels == 2)
        image.channels = 3;  // with four channels the pixels decide whether z is among them
    } catch (const TooManyPixels&) {
      throw;
    } catch (const Error&) {
      // compute reports it
    }
    if (image.semantic != Semantic::normal || channels == 0) return out;
    try {
      if (const auto normals = interpretation_in(p).normal) require_channels(*normals, channels);
    } catch (const Error& e) {
      throw Error("interpret", fmt::format("{}: {}", std::filesystem::path(path).filename().string(), e.what()));
    }
    return out;
  };
  t.lint = [](const Params& p, const InputForecasts&) {
    const bool is_colour = std::get<std::string>(p.at("semantic")) == "base_color";
    return is_colour ? lint_of_colour("\"path\"", std::get<std::string>(p.at("path"))) : Lints{};
  };
  t.compute = compute_load_map;
  return t;
}

}  // namespace terrazzo
