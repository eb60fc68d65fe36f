#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/image_io/color.h"
#include "core/material/map_description.h"
#include "nodes/exchange/export_preset.h"

namespace terrazzo {

namespace {

using nlohmann::ordered_json;

constexpr std::string_view letters = "rgba";

std::string_view way_of(NormalY y) {
  return y == NormalY::up ? "up" : "down";
}

/// Which channels of the file hold each map, in the order of the maps' own channels.
std::vector<std::pair<std::string, std::string>> places(const FileContent& file) {
  std::vector<std::pair<std::string, std::string>> out;
  for (size_t i = 0; i < file.channels.size(); i++) {
    const std::string& map = file.channels[i].map;
    if (map.empty()) continue;
    const auto at = std::ranges::find(out, map, &std::pair<std::string, std::string>::first);
    if (at == out.end())
      out.emplace_back(map, std::string(1, letters[i]));
    else
      at->second += letters[i];
  }
  return out;
}

}  // namespace

std::string described(const FileContent& file) {
  const ImageInfo& info = file.image->info();
  if (!file.whole_map().empty()) {
    if (is_color(info.semantic)) return "colours, sRGB";
    if (info.semantic == Semantic::normal)
      return fmt::format("normals, green {} ({}), not sRGB", way_of(info.normal_y),
                         info.normal_y == NormalY::up ? "OpenGL" : "DirectX");
    return fmt::format("{}, not sRGB", file.whole_map());
  }
  constexpr std::array<std::string_view, 4> names = {"red", "green", "blue", "alpha"};
  if (is_color(info.semantic)) return fmt::format("colours, sRGB; alpha: {}", file.channels.back().map);
  std::string out;
  for (size_t i = 0; i < file.channels.size(); i++) {
    const FileContent::Channel& c = file.channels[i];
    const std::string what = c.map.empty() ? fmt::format("{:g}", c.constant) : (c.inverted ? "1 - " : "") + c.map;
    out += fmt::format("{}{}: {}", i == 0 ? "" : ", ", names[i], what);
  }
  return out + "; not sRGB";
}

std::string metadata_line(const FileContent& file, PhysicalSize metres) {
  FileDescription out = description_of(file.whole_map(), file.image->info(), metres);
  if (!file.whole_map().empty()) return description_line(out);
  out.maps.clear();
  for (const auto& [map, where] : places(file))
    out.maps.push_back({.name = map, .channels = where, .inverted = file.find(map)->inverted});
  return description_line(out);
}

std::string sidecar_text(const ExportPreset& preset, const std::string& material, PhysicalSize metres,
                         const std::vector<std::pair<std::string, const FileContent*>>& files) {
  ordered_json list = ordered_json::object();
  for (const auto& [name, file] : files) {
    const ImageInfo& info = file->image->info();
    ordered_json entry;
    for (const auto& [map, where] : places(*file)) {
      entry["maps"][map] = where;
      if (file->find(map)->inverted) entry["inverted"].push_back(map);
    }
    if (info.semantic == Semantic::normal) entry["normal_y"] = way_of(info.normal_y);
    entry["color_space"] = info.color_space;
    list[name] = std::move(entry);
  }
  ordered_json json = {{"terrazzo_material", 1}, {"name", material}, {"preset", preset.name}};
  if (metres.is_known()) json["metres"] = {metres.width, metres.height};
  json["files"] = std::move(list);
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace terrazzo
