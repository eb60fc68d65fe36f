#include "core/material/recognised_map.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/material/map_description.h"
#include "core/material/material.h"
#include "core/naming/file_words.h"
#include "core/naming/map_keyword.h"

namespace terrazzo {

namespace {

std::vector<RecognisedMap> maps_of(const KeywordMatch& match, const MapFile& file) {
  std::vector<RecognisedMap> maps;
  for (const WordPart& part : match.parts) {
    RecognisedMap m;
    m.map = part.map.empty() ? name_of(part.semantic) : part.map;
    m.semantic = part.semantic;
    m.file = file.name;
    m.layer = file.layer;
    m.channels = part.channels;
    m.inverted = part.inverted;
    if (part.semantic == Semantic::normal) m.normal_y = match.normal_y;
    maps.push_back(std::move(m));
  }
  return maps;
}

int level_of_detail_in(const std::vector<NameWord>& words) {
  int level = 0;
  for (const NameWord& w : words) level = std::max(level, level_of_detail(w.text).value_or(0));
  return level;
}

std::string without_extension(const std::string& file) {
  return lowercase(file.substr(0, file.rfind('.')));
}

/// Whether the file's name is that of a mask, such as mask_moss.png.
bool names_a_map(const std::string& file, Semantic semantic) {
  return semantic_of_map(without_extension(file)) == semantic;
}

/// Whether the description is of more channels: a program may have dropped channels and kept the description.
bool needs_more_channels(const FileDescription& said, int channels) {
  const std::string_view held = std::string_view("rgba").substr(0, channels ? size_t(channels) : 4);
  return std::any_of(said.maps.begin(), said.maps.end(),
                     [&](const DescribedMap& d) { return d.channels.find_first_not_of(held) != std::string::npos; });
}

RecognisedFile named_by_file(const MapFile& file) {
  RecognisedFile out;
  const std::vector<NameWord> words = without_workflow(words_of_file(file.name), file.channels);
  out.level_of_detail = level_of_detail_in(words);
  KeywordMatch match = find_keyword(words, file.channels);
  if (!match) match = normals_by_convention(words, file.channels);
  if (!match) {
    const std::string stem = file.name.substr(0, file.name.rfind('.'));
    out.stem = stem_in(stem);
    out.stem_with_fillers = stem_in(stem, Fillers::kept);
    return out;
  }
  size_t first = match.first, last = match.last;  // numbers around the word belong to the material: wall_01_color
  while (first + 1 < last && is_digit(words[first].text[0])) first++;
  while (first + 1 < last && is_digit(words[last - 1].text[0])) last--;
  out.maps = maps_of(match, file);
  out.stem = stem_of(file.name, words, first, last);
  out.stem_is_behind = !out.stem.words.empty() && stem_of(file.name, words, first, words.size()).words.empty();
  out.stem_with_fillers = out.stem_is_behind ? out.stem : stem_of(file.name, words, first, last, Fillers::kept);
  out.further_words = out.stem_is_behind ? 0 : further_words(words, match);
  return out;
}

/// The words of a layer before its keyword: "moss" of moss.albedo, none of arm.roughness.
std::string material_in_layer(const std::string& layer, const std::vector<NameWord>& words, const KeywordMatch& match) {
  const std::vector<NameWord> before(words.begin(), words.begin() + ptrdiff_t(match.first));
  if (before.size() < 2 || find_keyword(before, 0)) return "";
  return layer.substr(before[1].begin, before.back().end - before[1].begin);
}

RecognisedFile named_by_layer(const MapFile& file) {
  std::vector<NameWord> words = words_in(file.layer);
  words.insert(words.begin(), NameWord{"layer"});  // so that single letters are not the first word
  const KeywordMatch match = find_keyword(words, file.channels);
  if (!match) return {};
  RecognisedFile out = named_by_file({.name = file.name, .size = file.size});
  out.maps = maps_of(match, file);
  out.told_by_layer = true;
  out.further_words = further_words(words, match);
  const std::string more = material_in_layer(file.layer, words, match);
  if (more.empty() || !udim_tile_of(out.stem.shown).empty()) return out;
  out.stem = stem_in(out.stem.shown + "_" + more);
  out.stem_with_fillers = stem_in(out.stem_with_fillers.shown + "_" + more, Fillers::kept);
  return out;
}

RecognisedFile named(const MapFile& file) {
  if (!file.layer.empty())
    if (RecognisedFile found = named_by_layer(file); !found.maps.empty()) return found;
  return named_by_file(file);
}

}  // namespace

std::string MapFile::telling_name() const {
  if (layer.empty()) return name;
  const size_t dot = std::min(name.rfind('.'), name.size());
  return name.substr(0, dot) + "_" + layer + name.substr(dot);
}

std::string RecognisedMap::place() const {
  if (layer.empty() && channels.empty()) return file;
  if (layer.empty()) return fmt::format("{} (channel {})", file, channels);
  return fmt::format("{} (layer {}{})", file, layer, channels.empty() ? "" : ", channel " + channels);
}

RecognisedFile recognise_file(const MapFile& file) {
  RecognisedFile out = named(file);
  const std::optional<FileDescription> said = file_description(file.description);
  if (!said || !file.layer.empty() || needs_more_channels(*said, file.channels)) return out;
  const bool is_map_name = names_a_map(file.name, said->maps.front().semantic);
  if (out.maps.empty() && is_map_name) out.stem = out.stem_with_fillers = Stem();
  const std::vector<RecognisedMap> named_maps = std::move(out.maps);
  std::vector<RecognisedMap>& maps = out.maps;
  maps.clear();
  for (const DescribedMap& d : said->maps)
    maps.push_back({.map = d.name,
                    .semantic = d.semantic,
                    .file = file.name,
                    .channels = d.channels,
                    .inverted = d.inverted,
                    .normal_y = d.semantic == Semantic::normal ? said->normal_y : std::nullopt,
                    .color_space = said->color_space,
                    .said_by = "its description"});
  if (maps.size() > 1 || !maps.front().channels.empty()) return out;
  // The file's name may be more precise about the map and the direction of green.
  RecognisedMap& only = maps.front();
  const bool agree = named_maps.size() == 1 && named_maps.front().semantic == only.semantic;
  if (agree && !only.normal_y) only.normal_y = named_maps.front().normal_y;
  if (only.map != name_of(only.semantic)) return out;
  if (agree)
    only.map = named_maps.front().map;
  else if (is_map_name)
    only.map = without_extension(file.name);
  return out;
}

std::vector<RecognisedMap> recognise_map(const MapFile& file) {
  return recognise_file(file).maps;
}

std::string reason_to_skip(const std::string& name) {
  static const std::set<std::string> pictures = {"preview", "thumb",     "thumbnail", "sphere",      "render",
                                                 "icon",    "billboard", "swatch",    "contactsheet"};
  std::string glued;
  for (const NameWord& word : words_of_file(name)) {
    const std::string& w = word.text;
    if (pictures.count(without_digits(w))) return "a picture of the material, not a map";
    if (w.starts_with("mip") && w.size() > 3 && is_digit(w[3])) return "a level of a mip chain";
    glued += w;
  }
  for (const std::string_view other : {"worldspacenormal", "objectspacenormal", "bentnormal"})
    if (glued.find(other) != std::string::npos) return "its normals are not those of the surface in tangent space";
  return "";
}

std::string known_words(Semantic semantic) {
  std::string words;
  for (const MapWord& w : map_words)
    if (w.part_count == 1 && w.parts[0].semantic == semantic && w.parts[0].map.empty() &&
        (w.strength == WordStrength::full || w.word.size() > 2))
      words += (words.empty() ? "" : ", ") + std::string(w.word);
  return words;
}

}  // namespace terrazzo
