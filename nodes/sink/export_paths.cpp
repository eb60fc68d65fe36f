#include "nodes/sink/export_paths.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "core/base/suggest.h"
#include "core/image_io/image_libraries.h"
#include "core/naming/file_stems.h"
#include "nodes/common/node_helpers.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view udim = "<UDIM>";

std::string with_tile(const char* param, std::string pattern, std::string& material) {
  if (pattern.find(udim) == std::string::npos) return pattern;
  const std::string tile = udim_tile_of(material);
  if (tile.empty())
    throw Error(param, fmt::format("<UDIM> in \"{}\" is the tile that the material's name ends in, such as "
                                   "wall.1002; the material is called \"{}\"",
                                   pattern, material));
  material = without_udim_tile(material);
  for (size_t at; (at = pattern.find(udim)) != std::string::npos;) pattern.replace(at, udim.size(), tile);
  return pattern;
}

/// Names come from files, documents and programs, and must not lead to another folder when inserted into a path.
void require_part_of_path(const char* param, const char* what, const std::string& name) {
  if (name.find_first_of(std::string_view("/\0", 2)) == std::string::npos &&
      (name.empty() || name.find_first_not_of('.') != std::string::npos))
    return;
  throw Error(param, fmt::format("the {0} is called {1:?}, which cannot be a part of a file's name; give it another "
                                 "name, or write a path without {{{0}}}",
                                 what, name));
}

}  // namespace

std::string filled(const char* param, const std::string& given, const PathValues& values) {
  std::string material = values.material;
  const std::string pattern = with_tile(param, given, material);
  const std::map<std::string, std::string> known = {{"map", values.map},
                                                    {"material", material},
                                                    {"width", fmt::format("{}", values.size.width)},
                                                    {"height", fmt::format("{}", values.size.height)}};
  std::string out;
  for (size_t i = 0; i < pattern.size(); i++) {
    if (pattern[i] != '{') {
      out += pattern[i];
      continue;
    }
    const size_t end = pattern.find('}', i);
    if (end == std::string::npos) throw Error(param, fmt::format("expected a }} after every {{ in \"{}\"", pattern));
    const std::string name = pattern.substr(i + 1, end - i - 1);
    const auto at = known.find(name);
    if (at == known.end())
      throw Error(param, fmt::format("unknown placeholder {{{0}}} in \"{1}\"; known are {{map}}, {{material}}, "
                                     "{{width}}, {{height}} and <UDIM>; a parameter of the graph is written ${0}",
                                     name, pattern));
    require_part_of_path(param, name.c_str(), at->second);
    out += at->second;
    i = end;
  }
  return out;
}

FileFormat required_format(const char* param, const fs::path& path) {
  if (const auto format = format_from(path)) return *format;
  const std::string extension = path.extension().string();
  throw Error(param,
              fmt::format("the extension decides the file format, and \"{}\" ends in {}; expected .png, .tif, "
                          ".tiff, .exr, .jpg, .jpeg, .tga or .tx{}",
                          path.filename().string(), extension.empty() ? "no extension" : "\"" + extension + "\"",
                          did_you_mean(extension, {".png", ".tif", ".tiff", ".exr", ".jpg", ".jpeg", ".tga", ".tx"})));
}

void require_pattern_for(const std::string& pattern, const std::vector<std::string>& maps) {
  if (pattern.empty())
    throw Error("path", "expected a file name pattern such as out/{map}.png, since a material is connected");
  if (maps.size() > 1 && pattern.find("{map}") == std::string::npos)
    throw Error("path", fmt::format("\"{}\" names one file, but there are {} maps ({}); write {{map}} where the map's "
                                    "name goes, or choose one with the parameter `maps`",
                                    pattern, maps.size(), fmt::join(maps, ", ")));
}

void require_exact_format(const fs::path& path) {
  const FileFormat format = required_format("uv_path", path);
  if (format == FileFormat::exr || format == FileFormat::png || format == FileFormat::tiff) return;
  const char* why = format == FileFormat::jpeg ? "is exact and JPEG is not"
                    : format == FileFormat::tx ? "has no mip levels"
                                               : "needs 16 bits and TGA has 8";
  throw Error("uv_path",
              fmt::format("the uv map {}; expected .exr, .png or .tif, found \"{}\"", why, path.filename().string()));
}

const char* param_of_uv(const Params& params) {
  const bool own = !std::get<std::string>(params.at("uv_path")).empty();
  if (!own && std::get<std::string>(params.at("path")).empty())
    throw Error("uv_path", "expected a file name such as out/uv.exr, since a uv map is connected");
  return own ? "uv_path" : "path";
}

bool is_csv(const fs::path& path) {
  if (path.extension() == ".csv") return true;
  if (path.extension() == ".json") return false;
  throw Error("report_path",
              fmt::format("expected a file name that ends in .json or .csv, found \"{}\"", path.filename().string()));
}

void require_report_path(const fs::path& path) {
  if (path.empty())
    throw Error("report_path", "expected a file name such as out/report.json, since a report is connected");
  is_csv(path);
}

void require_some_input(bool connected) {
  if (!connected) throw Error("material", "expected a wire to `material`, `uv` or `report`; found none");
}

namespace {

/// The file of a pattern whose placeholders are partly known; only its folder if its name is not.
FutureFile future_file(const char* param, const std::string& pattern, const std::string& map, const std::string& what) {
  std::string path = pattern;
  if (path.find("{map}") != std::string::npos) require_part_of_path(param, "map", map);
  for (size_t at; !map.empty() && (at = path.find("{map}")) != std::string::npos;) path.replace(at, 5, map);
  const fs::path known = path.substr(0, std::min(path.find('{'), path.find(udim)));
  return {param, known.parent_path(), known == path ? known.filename().string() : "", what};
}

}  // namespace

Forecast foresee_export(const Params& params, const InputForecasts& inputs) {
  const auto text = [&](const char* name) -> const std::string& { return std::get<std::string>(params.at(name)); };
  require_some_input(!inputs.empty());
  Forecast out;
  const auto require_writer = [&](const char* param) {
    if (const auto format = format_from(text(param)); format && *format != FileFormat::png) require_image_libraries();
  };
  if (const auto material = inputs.find("material"); material != inputs.end()) {
    std::vector<std::string> maps;
    const Texts& chosen = std::get<Texts>(params.at("maps"));
    require_writer("path");
    preflight_maps("maps", chosen, material->second.front());
    for (const std::string& m : chosen.empty() ? material->second.front().maps : chosen)
      if (std::find(maps.begin(), maps.end(), m) == maps.end()) maps.push_back(m);
    require_pattern_for(text("path"), maps);
    if (maps.empty()) maps = {""};
    for (const std::string& map : maps)
      out.files.push_back(
          future_file("path", text("path"), map, map.empty() ? "a map" : fmt::format("the map \"{}\"", map)));
  }
  if (inputs.count("uv")) {
    const char* param = param_of_uv(params);
    require_writer(param);
    require_exact_format(text(param));
    out.files.push_back(future_file(param, text(param), "uv", "the uv map"));
  }
  if (inputs.count("report")) {
    require_report_path(text("report_path"));
    out.files.push_back(future_file("report_path", text("report_path"), "", "the report"));
  }
  return out;
}

}  // namespace terrazzo
