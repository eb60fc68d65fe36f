#include "core/material/map_names.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "core/base/suggest.h"
#include "core/material/recognised_map.h"

namespace terrazzo {

namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Suggests by spelling, or by the word's meaning in a file's name: "ao" is "ambient_occlusion".
std::string did_you_mean_map(const std::string& name, const std::vector<std::string>& known) {
  if (std::string question = did_you_mean(name, known); !question.empty()) return question;
  for (const RecognisedMap& m : recognise_map({.name = name + ".png", .size = {}}))
    if (m.channels.empty() && contains(known, m.map)) return fmt::format(" (did you mean \"{}\"?)", m.map);
  return "";
}

/// The maps of `from` that are certainly missing in the other.
std::vector<std::string> maps_missing(const KnownMaps& from, const KnownMaps& other) {
  if (!other.possible_maps) return {};
  std::vector<std::string> missing = from.maps;
  std::erase_if(missing,
                [&](const std::string& m) { return contains(other.maps, m) || contains(*other.possible_maps, m); });
  return missing;
}

}  // namespace

std::vector<std::string> names_of(const std::vector<Map>& maps) {
  std::vector<std::string> names;
  for (const Map& m : maps) names.push_back(m.name);
  return names;
}

void require_maps(const std::string& param, const std::vector<std::string>& wanted,
                  const std::vector<std::string>& known, const std::string& whose) {
  std::vector<std::string> unknown;
  for (const std::string& name : wanted) {
    if (contains(known, name)) continue;
    std::string text = fmt::format("\"{}\"{}", name, did_you_mean_map(name, known));
    if (std::find(unknown.begin(), unknown.end(), text) == unknown.end()) unknown.push_back(std::move(text));
  }
  if (unknown.empty()) return;
  std::string all = unknown.front();
  for (size_t i = 1; i < unknown.size(); i++) all += (i + 1 == unknown.size() ? " and " : ", ") + unknown[i];
  throw Error(param, fmt::format("there {} {}; {} has {}", unknown.size() == 1 ? "is no map" : "are no maps", all,
                                 whose, fmt::join(known, ", ")));
}

void require_same_maps(const std::string& port, const std::vector<KnownMaps>& materials) {
  const KnownMaps& first = materials.front();
  for (size_t i = 1; i < materials.size(); i++) {
    const KnownMaps& other = materials[i];
    std::vector<std::string> differences, uncommon;
    if (const auto less = maps_missing(first, other); !less.empty()) {
      differences.push_back(fmt::format("lacks \"{}\"", fmt::join(less, "\", \"")));
      uncommon = less;
    }
    if (const auto more = maps_missing(other, first); !more.empty()) {
      differences.push_back(fmt::format("also has \"{}\"", fmt::join(more, "\", \"")));
      uncommon.insert(uncommon.end(), more.begin(), more.end());
    }
    if (differences.empty()) continue;
    throw Error(
        port,
        fmt::format("expected the same maps in all materials, {} as in the first; material {}{} {}; leave maps "
                    "out where they are loaded (of a node NAME of type \"load_material\" by --set "
                    "'NAME.maps={{\"{}\": \"\"}}'), or add them with \"make_material\"",
                    fmt::join(first.maps, ", "), i + 1, other.name.empty() ? "" : fmt::format(" (\"{}\")", other.name),
                    fmt::join(differences, ", "), fmt::join(uncommon, "\": \"\", \"")));
  }
}

void require_one_shape(const std::string& port, const std::vector<std::pair<std::string, Size>>& maps) {
  const auto fits = [&](const auto& map) { return same_shape(map.second, maps.front().second); };
  if (std::all_of(maps.begin(), maps.end(), fits)) return;
  std::vector<std::pair<Size, std::string>> by_size;
  for (const auto& [name, size] : maps) {
    const auto same = std::find_if(by_size.begin(), by_size.end(), [s = size](const auto& e) { return e.first == s; });
    if (same == by_size.end())
      by_size.emplace_back(size, name);
    else
      same->second += ", " + name;
  }
  std::string all;
  for (const auto& [size, names] : by_size)
    all += fmt::format("{}{} ({})", all.empty() ? "" : ", ", describe(size), names);
  throw Error(port,
              fmt::format("all maps must show the same area, but their aspect ratios differ: {}. Crop or scale the "
                          "files to one aspect ratio, or leave some out; in a graph, use \"crop\" and \"resize\"",
                          all));
}

void require_one_shape(const std::string& port, const Material& material) {
  std::vector<std::pair<std::string, Size>> maps;
  for (const Map& map : material.maps()) maps.emplace_back(map.name, map.image->size());
  require_one_shape(port, maps);
}

}  // namespace terrazzo
