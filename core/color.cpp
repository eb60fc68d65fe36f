#include "core/color.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <mutex>

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/suggest.h"
#include "core/text.h"

namespace OCIO = OCIO_NAMESPACE;

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

OCIO::ColorSpaceRcPtr make_space(const char* name, const char* description) {
  OCIO::ColorSpaceRcPtr space = OCIO::ColorSpace::Create();
  space->setName(name);
  space->setDescription(description);
  space->setBitDepth(OCIO::BIT_DEPTH_F32);
  return space;
}

/// Reference: linear light, Rec.709 primaries.
OCIO::ConstConfigRcPtr built_in_config() {
  OCIO::ConfigRcPtr config = OCIO::Config::Create();
  config->setVersion(2, 0);
  config->addColorSpace(make_space("lin_rec709", "Linear light, Rec.709 primaries, D65"));

  OCIO::ColorSpaceRcPtr srgb = make_space("srgb_texture", "The sRGB transfer function, Rec.709 primaries, D65");
  OCIO::ExponentWithLinearTransformRcPtr curve = OCIO::ExponentWithLinearTransform::Create();
  curve->setGamma({2.4, 2.4, 2.4, 1.0});
  curve->setOffset({0.055, 0.055, 0.055, 0.0});
  curve->setNegativeStyle(OCIO::NEGATIVE_LINEAR);
  srgb->setTransform(curve, OCIO::COLORSPACE_DIR_TO_REFERENCE);
  config->addColorSpace(srgb);

  // AP1 (white point of ACES) to Rec.709 (D65) with the Bradford adaptation: SMPTE RP 177 applied to the primaries.
  OCIO::ColorSpaceRcPtr acescg = make_space("acescg", "Linear light, AP1 primaries, the white point of ACES");
  OCIO::MatrixTransformRcPtr matrix = OCIO::MatrixTransform::Create();
  const double to_rec709[16] = {1.70505099265815,
                                -0.621792120657,
                                -0.0832588720011,
                                0,  //
                                -0.130256417507,
                                1.14080473657,
                                -0.0105483190684,
                                0,  //
                                -0.0240033568046,
                                -0.128968976065,
                                1.15297233287,
                                0,  //
                                0,
                                0,
                                0,
                                1};
  matrix->setMatrix(to_rec709);
  acescg->setTransform(matrix, OCIO::COLORSPACE_DIR_TO_REFERENCE);
  config->addColorSpace(acescg);

  OCIO::ColorSpaceRcPtr raw = make_space("raw", "Values that are no colours; never converted");
  raw->setIsData(true);
  config->addColorSpace(raw);
  config->setRole(OCIO::ROLE_REFERENCE, "lin_rec709");
  config->setRole(OCIO::ROLE_SCENE_LINEAR, "lin_rec709");
  config->setRole(OCIO::ROLE_DATA, "raw");
  config->setRole(OCIO::ROLE_DEFAULT, "raw");
  return config;
}

/// Empty for the built-in configuration.
std::string config_path(const std::string& given) {
  if (!given.empty()) return given;
  const char* variable = std::getenv("OCIO");
  return variable ? variable : "";
}

struct Configuration {
  OCIO::ConstConfigRcPtr config;
  std::string where;  ///< for messages
  Digest identity;
};

Digest identity_of(const std::string& path) {
  Hasher h;
  h.add("color configuration");
  for (const fs::path& file : color_config_files(path)) {
    std::ifstream in(file, std::ios::binary);
    const std::string content((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    h.add(content);
  }
  return h.digest();
}

Configuration load(const std::string& path) {
  if (path.empty()) return {built_in_config(), "the built-in configuration", Hasher().add("built-in 1").digest()};
  try {
    OCIO::ConstConfigRcPtr config = OCIO::Config::CreateFromFile(path.c_str());
    return {config, path, identity_of(path)};
  } catch (const OCIO::Exception& e) {
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

std::vector<std::string> names_in(const OCIO::ConstConfigRcPtr& config) {
  std::vector<std::string> names;
  for (int i = 0; i < config->getNumColorSpaces(); i++) names.emplace_back(config->getColorSpaceNameByIndex(i));
  return names;
}

/// What the configuration itself calls a space; empty if it has none of that name.
std::string name_in_config(const Configuration& c, const std::string& name) {
  const auto has = [&](const std::string& n) -> std::string {
    const OCIO::ConstColorSpaceRcPtr space = c.config->getColorSpace(n.c_str());
    return space ? space->getName() : "";
  };
  if (std::string found = has(name); !found.empty()) return found;
  const CommonSpace* common = find_common(name);
  if (!common) return "";
  if (std::string found = has(common->name); !found.empty()) return found;
  for (const std::string& alias : common->aliases)
    if (std::string found = has(alias); !found.empty()) return found;
  return "";
}

[[noreturn]] void fail_unknown(const Configuration& c, const std::string& name) {
  std::vector<std::string> known = names_in(c.config);
  const std::string list = fmt::format("{}", fmt::join(known, ", "));
  for (const CommonSpace& s : common_spaces()) known.insert(known.end(), s.aliases.begin(), s.aliases.end());
  throw Error(fmt::format("there is no colour space \"{}\" in {}, which knows {}{}", name, c.where, list,
                          did_you_mean(name, known)));
}

std::string required_name(const Configuration& c, const std::string& name) {
  const std::string found = name_in_config(c, name);
  if (found.empty()) fail_unknown(c, name);
  return found;
}

void apply(const OCIO::ConstCPUProcessorRcPtr& processor, float* pixels, int channels, int64_t count) {
  if (channels >= 3) {
    OCIO::PackedImageDesc image(pixels, count, 1, 3, OCIO::BIT_DEPTH_F32, sizeof(float), channels * sizeof(float),
                                count * channels * sizeof(float));
    processor->apply(image);
    return;
  }
  std::vector<float> grey(size_t(count) * 3);
  for (int64_t i = 0; i < count; i++) std::fill_n(&grey[i * 3], 3, pixels[i * channels]);
  apply(processor, grey.data(), 3, count);
  for (int64_t i = 0; i < count; i++) pixels[i * channels] = grey[i * 3];
}

}  // namespace

std::vector<std::string> color_space_names(const std::string& config) {
  return names_in(configuration(config).config);
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
  OCIO::ConstCPUProcessorRcPtr processor;
  try {
    // Lossless: without the approximations of pow that would shift 16-bit values.
    processor = c.config->getProcessor(source_name.c_str(), required_name(c, to).c_str())
                    ->getOptimizedCPUProcessor(OCIO::OPTIMIZATION_LOSSLESS);
  } catch (const OCIO::Exception& e) {
    throw Error(fmt::format("{} cannot convert from {} to {}: {}", c.where, from, to, e.what()));
  }
  const Digest recipe =
      Hasher().add("convert_color 1").add(c.identity).add(from).add(info.color_space).add(image->digest()).digest();
  return Image::computed(info, recipe, [image, processor](const Rect& region, float* out) {
    image->read(region, out);
    apply(processor, out, image->channels(), region.area());
  });
}

std::vector<fs::path> color_config_files(const std::string& given) {
  const std::string path = config_path(given);
  if (path.empty()) return {};
  std::vector<fs::path> files = {path};
  try {
    const OCIO::ConstConfigRcPtr config = OCIO::Config::CreateFromFile(path.c_str());
    for (int i = 0; i < config->getNumSearchPaths(); i++) {
      const fs::path folder = fs::path(path).parent_path() / config->getSearchPath(i);
      std::error_code failure;
      for (const fs::directory_entry& e : fs::directory_iterator(folder, failure))
        if (e.is_regular_file()) files.push_back(e.path());
    }
  } catch (const OCIO::Exception&) {
    return files;  // whoever uses the configuration reports what is wrong with it
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

}  // namespace terrazzo
