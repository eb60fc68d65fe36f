#include "core/image/color.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <mutex>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "core/base/suggest.h"
#include "core/base/text.h"
#include "core/file/file_io.h"
#include "core/image/image_libraries.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

/// Our names for the spaces everybody has, and what other configurations call them.
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

/// The four spaces that need no file. Their names are known here, so that only conversions load OpenColorIO.
class BuiltInColors final : public ColorConfiguration {
 public:
  std::vector<std::string> names() const override { return {"lin_rec709", "srgb_texture", "acescg", "raw"}; }
  std::string find(const std::string& name) const override {
    static const std::map<std::string, std::string> roles = {
        {"reference", "lin_rec709"}, {"scene_linear", "lin_rec709"}, {"data", "raw"}, {"default", "raw"}};
    const std::string wanted = lowercase(name);
    if (const auto role = roles.find(wanted); role != roles.end()) return role->second;
    const std::vector<std::string> known = names();
    return std::find(known.begin(), known.end(), wanted) == known.end() ? "" : wanted;
  }
  Conversion conversion(const std::string& from, const std::string& to) const override {
    static const std::shared_ptr<const ColorConfiguration> colors = image_libraries().load_colors("");
    return colors->conversion(from, to);
  }
  std::vector<std::string> search_paths() const override { return {}; }
};

/// Empty for the built-in configuration.
std::string config_path(const std::string& given) {
  if (!given.empty()) return given;
  const char* variable = std::getenv("OCIO");
  return variable ? variable : "";
}

struct Configuration {
  std::shared_ptr<const ColorConfiguration> config;
  std::string where;  ///< for messages
  Digest identity;
};

Digest identity_of(const std::string& path) {
  Hasher h;
  h.add("color configuration");
  for (const fs::path& file : color_config_files(path)) {
    try {
      h.add(read_file(file));
    } catch (const FileError&) {
      h.add("");  // loading it says what is wrong
    }
  }
  return h.digest();
}

Configuration load(const std::string& path) {
  if (path.empty())
    return {std::make_shared<BuiltInColors>(), "the built-in configuration", Hasher().add("built-in 1").digest()};
  try {
    return {image_libraries().load_colors(path), path, identity_of(path)};
  } catch (const Error& e) {
    throw Error(fmt::format("cannot read the OpenColorIO configuration {}: {}", path, e.what()));
  }
}

/// A configuration stays loaded as long as its file does not change.
Configuration configuration(const std::string& given) {
  static std::mutex mutex;
  static std::map<std::string, std::pair<fs::file_time_type, Configuration>> loaded;
  const std::string path = config_path(given);
  std::error_code missing;
  const fs::file_time_type time = path.empty() ? fs::file_time_type() : fs::last_write_time(path, missing);
  const std::lock_guard lock(mutex);
  const auto at = loaded.find(path);
  if (at != loaded.end() && at->second.first == time) return at->second.second;
  return loaded.insert_or_assign(path, std::pair(time, load(path))).first->second.second;
}

/// What the configuration itself calls a space; empty if it has none of that name.
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
  return configuration(config).config->names();
}

std::string canonical_color_space(const std::string& name, const std::string& config) {
  const Configuration c = configuration(config);
  const CommonSpace* common = find_common(name);
  if (common && common->name == "raw") return common->name;
  const std::string found = required_name(c, name);
  return common ? common->name : found;
}

bool is_color(Semantic semantic) {
  return semantic == Semantic::base_color || semantic == Semantic::emission || semantic == Semantic::specular;
}

std::string assumed_color_space(Semantic semantic, Depth depth) {
  if (!is_color(semantic)) return "raw";
  return depth >= Depth::f16 ? "lin_rec709" : "srgb_texture";
}

ImagePtr convert_color(const ImagePtr& image, const std::string& to, const std::string& config) {
  const Configuration c = configuration(config);
  ImageInfo info = image->info();
  const std::string from = info.color_space;
  info.color_space = canonical_color_space(to, config);
  if (from == "raw" || from == info.color_space) return image;
  const std::string source_name = required_name(c, from);
  if (info.color_space == "raw") return Image::redescribed(image, info);
  ColorConfiguration::Conversion convert;
  try {
    convert = c.config->conversion(source_name, required_name(c, to));
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

std::vector<fs::path> color_config_files(const std::string& given) {
  const std::string path = config_path(given);
  if (path.empty()) return {};
  std::vector<fs::path> files = {path};
  try {
    for (const std::string& searched : image_libraries().load_colors(path)->search_paths()) {
      const fs::path folder = fs::path(path).parent_path() / searched;
      std::error_code failure;
      for (const fs::directory_entry& e : fs::directory_iterator(folder, failure))
        if (e.is_regular_file()) files.push_back(e.path());
    }
  } catch (const Error&) {
    return files;  // whoever uses the configuration reports what is wrong with it
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

}  // namespace terrazzo
