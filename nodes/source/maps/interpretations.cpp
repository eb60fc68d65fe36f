#include "nodes/source/maps/interpretations.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/suggest.h"
#include "core/material/map_names.h"

namespace terrazzo {

namespace {

/// Stands in place of a map's name; its value is the map that the channel holds.
constexpr std::string_view alpha = "alpha";

const TextMap& interpretations_in(const Params& params) {
  static const TextMap none;
  const auto given = params.find("interpret");
  return given == params.end() ? none : std::get<TextMap>(given->second);
}

/// The semantic of the map that alpha holds. Throws Error.
Semantic semantic_in_alpha(const std::string& map) {
  const std::optional<Semantic> semantic = semantic_of_map(map);
  if (semantic && is_one_value(*semantic)) return *semantic;
  std::vector<std::string> known;
  for (const std::string_view name : semantic_names)
    if (is_one_value(*semantic_from(name))) known.emplace_back(name);
  throw Error(fmt::format("expected a map of one value that the alpha channel holds: {}; found \"{}\"{}",
                          fmt::join(known, ", "), map, did_you_mean(map, known)));
}

bool has_alpha(const RecognisedMap& map, const std::vector<MapFile>& files) {
  return std::ranges::any_of(files, [&](const MapFile& f) {
    return f.name == map.file && f.layer == map.layer && (f.channels == 2 || f.channels == 4);
  });
}

void take_from_alpha(const std::string& name, const std::vector<MapFile>& files, std::vector<RecognisedMap>& maps) {
  const std::string param = fmt::format("interpret.{}", alpha);
  std::set<std::pair<std::string, std::string>> places;
  for (const RecognisedMap& m : maps)
    if (has_alpha(m, files)) places.emplace(m.file, m.layer);
  if (places.empty()) throw Error(param, "no file of the material has an alpha channel");
  if (places.size() > 1) {
    std::vector<std::string> all;
    for (const auto& [file, layer] : places) all.push_back(file);
    throw Error(param, fmt::format("{} have an alpha channel; `maps` says which is meant, as in {{\"{}\": \"{}:a\"}}",
                                   fmt::join(all, " and "), name, all.front()));
  }
  const std::string file = places.begin()->first, layer = places.begin()->second;
  const auto is_there = [&](const RecognisedMap& m) { return m.file == file && m.layer == layer; };
  std::erase_if(maps, [&](const RecognisedMap& m) { return m.map == name || (is_there(m) && m.channels == "a"); });
  for (RecognisedMap& m : maps)
    if (is_there(m) && m.channels.empty()) m.channels = is_one_value(m.semantic) ? "r" : "rgb";
  maps.push_back({.map = name,
                  .semantic = semantic_in_alpha(name),
                  .file = file,
                  .channels = "a",
                  .said_by = "`interpret`",
                  .layer = layer});
}

}  // namespace

std::vector<std::string> problems_with_interpretations(const Params& params) {
  std::vector<std::string> problems;
  for (const auto& [map, words] : interpretations_in(params)) try {
      if (map == alpha)
        semantic_in_alpha(words);
      else if (const std::optional<Semantic> semantic = semantic_of_map(map))
        interpretation_from(words, *semantic);
    } catch (const Error& e) {
      problems.push_back(fmt::format("\"interpret.{}\": {}", map, e.what()));
    }
  return problems;
}

void interpret(const Params& params, const std::vector<MapFile>& files, std::vector<RecognisedMap>& maps) {
  const TextMap& given = interpretations_in(params);
  // Before the others, which may speak of what alpha holds.
  if (const auto in_alpha = given.find(std::string(alpha)); in_alpha != given.end()) {
    take_from_alpha(in_alpha->second, files, maps);
    std::stable_sort(maps.begin(), maps.end(),
                     [](const RecognisedMap& a, const RecognisedMap& b) { return a.semantic < b.semantic; });
  }
  for (const auto& [name, words] : given) {
    if (name == alpha) continue;
    const auto map = std::ranges::find(maps, name, &RecognisedMap::map);
    if (map == maps.end()) {
      Texts names;
      for (const RecognisedMap& m : maps) names.push_back(m.map);
      throw Error("interpret." + name, fmt::format("there is no map \"{}\"{}; the files hold {}", name,
                                                   did_you_mean(name, names), fmt::join(names, ", ")));
    }
    map->interpretation = interpretation_from(words, map->semantic);
    map->inverted = map->interpretation.inverted.value_or(map->inverted);
  }
}

}  // namespace terrazzo
