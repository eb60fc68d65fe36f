#include "core/image_io/color.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "core/base/suggest.h"
#include "core/base/text.h"
#include "core/image_io/color_configuration.h"

namespace terrazzo {

namespace {

/// Our names for common spaces, and their names in other configurations.
struct CommonSpace {
  std::string name;
  std::vector<std::string> aliases;
};
const std::vector<CommonSpace>& common_spaces() {
  static const std::vector<CommonSpace> spaces = {
      {"srgb_texture",
       {"srgb", "srgb texture", "srgb - texture", "utility - srgb - texture", "srgb_tx", "srgb_rec709_scene",
        "srgb encoded rec.709 (srgb)", "texture"}},
      {"lin_rec709",
       {"linear", "lin", "linear rec.709", "linear rec.709 (srgb)", "linear srgb", "lin_srgb", "lin_rec709_srgb",
        "lin_rec709_scene", "utility - linear - srgb", "utility - linear - rec.709"}},
      {"acescg", {"aces - acescg", "aces cg", "lin_ap1", "lin_ap1_scene"}},
      {"raw", {"utility - raw", "data", "non-color", "non-colour", "noncolor", "none"}},
  };
  return spaces;
}

const CommonSpace* find_common(const std::string& name) {
  const std::string wanted = lowercase(name);
  for (const CommonSpace& s : common_spaces())
    if (s.name == wanted || std::find(s.aliases.begin(), s.aliases.end(), wanted) != s.aliases.end()) return &s;
  return nullptr;
}

/// The configuration's own name of a space; empty if it does not have the space.
std::string name_in_config(const Configuration& c, const std::string& name) {
  if (std::string found = c.config->find(name); !found.empty()) return found;
  const CommonSpace* common = find_common(name);
  if (!common) return "";
  if (std::string found = c.config->find(common->name); !found.empty()) return found;
  for (const std::string& alias : common->aliases)
    if (std::string found = c.config->find(alias); !found.empty()) return found;
  return "";
}

[[noreturn]] void fail_unknown(const Configuration& c, const std::string& name) {
  std::vector<std::string> known = c.config->names();
  const std::string list = fmt::format("{}", fmt::join(known, ", "));
  for (const CommonSpace& s : common_spaces()) known.insert(known.end(), s.aliases.begin(), s.aliases.end());
  throw Error(fmt::format("there is no colour space \"{}\" in {}, which knows {}{}", name, c.where, list,
                          did_you_mean(name, known)));
}

std::string required_name(const Configuration& c, const std::string& name) {
  std::string found = name_in_config(c, name);
  if (found.empty()) fail_unknown(c, name);
  return found;
}

void apply(const ColorConfiguration::Conversion& convert, float* pixels, int channels, int64_t count) {
  if (channels >= 3) return convert(pixels, channels, count);
  std::vector<float> grey(size_t(count) * 3);
  for (int64_t i = 0; i < count; i++) std::fill_n(&grey[i * 3], 3, pixels[i * channels]);
  convert(grey.data(), 3, count);
  for (int64_t i = 0; i < count; i++) pixels[i * channels] = grey[i * 3];
}

}  // namespace

std::vector<std::string> color_space_names(const std::string& config) {
  return color_configuration(config).config->names();
}

std::string canonical_color_space(const std::string& name, const std::string& config) {
  const Configuration c = color_configuration(config);
  const CommonSpace* common = find_common(name);
  if (common && common->name == "raw") return common->name;
  const std::string found = required_name(c, name);
  return common ? common->name : found;
}

std::string assumed_color_space(Semantic semantic, Depth depth) {
  if (!is_color(semantic)) return "raw";
  return depth >= Depth::f16 ? "lin_rec709" : "srgb_texture";
}

ImagePtr convert_color(const ImagePtr& image, const std::string& to, const std::string& config) {
  const Configuration c = color_configuration(config);
  ImageInfo info = image->info();
  const std::string from = info.color_space;
  info.color_space = canonical_color_space(to, config);
  if (from == "raw" || from == info.color_space) return image;
  const std::string source_name = required_name(c, from);
  if (info.color_space == "raw") return Image::redescribed(image, info);
  ColorConfiguration::Conversion convert;
  try {
    convert = color_conversion(c, source_name, required_name(c, to));
  } catch (const Error& e) {
    throw Error(fmt::format("{} cannot convert from {} to {}: {}", c.where, from, to, e.what()));
  }
  const Digest recipe =
      Hasher().add("convert_color 1").add(c.identity).add(from).add(info.color_space).add(image->digest()).digest();
  const auto compute = [convert](std::span<const PixelView> in, const Rect& region, float* out) {
    in[0].read(region, out);
    apply(convert, out, in[0].channels(), region.area());
  };
  return Image::computed(info, recipe, {.sources = {image}, .compute = compute, .work = 20});
}

std::vector<std::filesystem::path> color_config_files(const std::string& config) {
  return files_of_configuration(config);
}

}  // namespace terrazzo
