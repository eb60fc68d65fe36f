#include "core/material/material_files.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/material/file_words.h"
#include "core/material/map_description.h"
#include "core/material/map_names.h"
#include "core/material/map_words.h"

namespace terrazzo {

namespace {

/// A telling phrase: words [first, last) of the name.
struct Telling {
  const MapWord* word = nullptr;
  size_t first = 0, last = 0;
  std::optional<NormalY> normal_y;
};

/// Some names glue what follows: "normalgl", "heightmap", "normalmap".
struct Phrase {
  std::string text;
  std::optional<NormalY> normal_y;
};
std::vector<Phrase> readings(const std::string& phrase) {
  std::vector<Phrase> out = {{phrase, std::nullopt}};
  for (const std::string_view ending : {"opengl", "directx", "ogl", "gl", "dx"})
    if (phrase.ends_with(ending)) {
      out.push_back({phrase.substr(0, phrase.size() - ending.size()), convention(ending)});
      break;
    }
  if (phrase.ends_with("map")) out.push_back({phrase.substr(0, phrase.size() - 3), std::nullopt});
  return out;
}

const MapWord* find_word(const Phrase& phrase, bool is_last, bool is_first, bool has_digits, int channels) {
  for (const MapWord& w : map_words) {
    if (w.word != phrase.text || (channels && channels < w.least_channels)) continue;
    if (phrase.normal_y && w.parts[0].semantic != Semantic::normal) continue;
    if (w.strength != WordStrength::full && !is_last) continue;
    if (w.strength == WordStrength::initial && (is_first || has_digits)) continue;
    return &w;
  }
  return nullptr;
}

Telling find_telling(const std::vector<NameWord>& words, int channels) {
  constexpr size_t longest_phrase = 4;
  size_t end_of_name = words.size();  // neutral words at the end aside
  while (end_of_name > 0 && is_neutral(words[end_of_name - 1].text)) end_of_name--;
  for (size_t last = words.size(); last > 0; last--)
    for (size_t first = last > longest_phrase ? last - longest_phrase : 0; first < last; first++) {
      std::string phrase;
      for (size_t i = first; i < last; i++) phrase += words[i].text;
      const std::string bare = without_digits(phrase);
      for (const Phrase& reading : readings(bare)) {
        const bool whole_name = first == 0 && last >= end_of_name;
        const bool one_letter = reading.text.size() <= 2;
        const MapWord* w = find_word(reading, last >= end_of_name, first == 0 && (!whole_name || one_letter),
                                     (one_letter || first == 0) && bare != phrase, channels);
        if (w) return {w, first, last, reading.normal_y};
      }
    }
  return {};
}

/// Poliigon ends names with the workflow that a map is for: COL_2K_METALNESS is no metallic map.
std::vector<NameWord> without_workflow(std::vector<NameWord> words, int channels) {
  if (words.size() < 3 || !is_resolution(words[words.size() - 2].text)) return words;
  if (words.back().text != "metalness" && words.back().text != "specular") return words;
  const std::vector<NameWord> before(words.begin(), words.end() - 2);
  if (find_telling(before, channels).last == before.size()) words.pop_back();
  return words;
}

/// The convention may stand beside the word for normal: normal_gl, nor_dx, gl_normal, normal_2k_directx.
std::optional<NormalY> convention_beside(const std::vector<NameWord>& words, const Telling& t) {
  for (size_t i = t.last; i < words.size(); i++) {
    if (const auto found = convention(words[i].text)) return found;
    if (i + 1 < words.size())
      if (const auto found = convention(words[i].text + words[i + 1].text)) return found;
  }
  if (t.first > 0) return convention(words[t.first - 1].text);
  return std::nullopt;
}

/// A recognised map with what decides between it and others of the same name; smaller is better.
struct Candidate {
  RecognisedMap map;
  Stem stem;
  int stand_in = 0;  ///< 0 the map itself, 1 packed, 2 inverted or a bump map
  int64_t area = 0;
  int lossiness = 0;
};

int lossiness_of(const std::string& file) {
  const std::string e = extension_of(file);
  if (e == "exr") return 0;
  if (e == "tif" || e == "tiff") return 1;
  if (e == "png") return 2;
  return e == "jpg" || e == "jpeg" || e == "webp" || e == "gif" ? 4 : 3;
}

bool is_bump(const std::string& file) {
  const std::vector<NameWord> words = words_of_file(file);
  return std::any_of(words.begin(), words.end(), [](const NameWord& w) { return without_digits(w.text) == "bump"; });
}

std::string size_text(const std::vector<MapFile>& files, const RecognisedMap& m) {
  const auto& [name, layer] = std::tie(m.file, m.layer);
  for (const MapFile& f : files)
    if (f.name == name && f.layer == layer && f.size.area() > 0)
      return fmt::format(" ({}x{})", f.size.width, f.size.height);
  return "";
}

void note_choice(const Candidate& chosen, const RecognisedMap& passed_over, const std::vector<MapFile>& files,
                 Recognition& out) {
  const RecognisedMap& taken = chosen.map;
  if (taken.semantic == Semantic::normal && taken.normal_y == NormalY::up && passed_over.normal_y == NormalY::down)
    out.notes.push_back(
        fmt::format("normal is {} (OpenGL); {} (DirectX) left out", taken.place(), passed_over.place()));
  else
    out.notes.push_back(fmt::format("{} is {}{}; {}{} left out", taken.map, taken.place(), size_text(files, taken),
                                    passed_over.place(), size_text(files, passed_over)));
}

std::string shown(const MapFile& f) {
  return f.layer.empty() ? f.name : fmt::format("{} (layer {})", f.name, f.layer);
}

std::vector<Candidate> candidates_among(const std::vector<MapFile>& files, Recognition& out) {
  std::vector<Candidate> found;
  for (const MapFile& f : files) {
    const std::string reason = reason_to_skip(f.telling_name());
    if (!reason.empty()) {
      out.notes.push_back(fmt::format("{} left out: {}", shown(f), reason));
      continue;
    }
    Stem stem;
    const std::vector<RecognisedMap> maps = recognise_map(f, &stem);
    if (maps.empty()) out.ignored.push_back(shown(f));
    for (const RecognisedMap& m : maps) {
      const bool stands_in = m.inverted || (m.semantic == Semantic::height && is_bump(f.telling_name()));
      found.push_back({m, stem, stands_in ? 2 : m.channels.empty() ? 0 : 1, f.size.area(), lossiness_of(f.name)});
    }
  }
  return found;
}

std::vector<RecognisedMap> recognise_name(const MapFile& file, Stem* stem) {
  const std::string name = file.telling_name();
  const std::vector<NameWord> words = without_workflow(words_of_file(name), file.channels);
  const Telling t = find_telling(words, file.channels);
  if (!t.word) return {};
  size_t first = t.first, last = t.last;  // numbers around the word belong to the material: wall_01_color
  while (first + 1 < last && is_digit(words[first].text[0])) first++;
  while (first + 1 < last && is_digit(words[last - 1].text[0])) last--;
  if (stem) *stem = stem_of(name, words, first, last);
  std::vector<RecognisedMap> maps;
  for (int i = 0; i < t.word->part_count; i++) {
    const WordPart& part = t.word->parts[i];
    RecognisedMap m;
    m.map = part.map.empty() ? name_of(part.semantic) : part.map;
    m.semantic = part.semantic;
    m.file = file.name;
    m.layer = file.layer;
    m.channels = part.channels;
    m.inverted = part.inverted;
    if (part.semantic == Semantic::normal) m.normal_y = t.normal_y ? t.normal_y : convention_beside(words, t);
    maps.push_back(std::move(m));
  }
  return maps;
}

}  // namespace

namespace {

std::string without_extension(const std::string& file) {
  return lowercase(file.substr(0, file.rfind('.')));
}

/// As mask_moss.png does.
bool names_a_map(const std::string& file, Semantic semantic) {
  return semantic_of_map(without_extension(file)) == semantic;
}

/// A program that dropped channels may have kept the description.
bool needs_more_channels(const FileDescription& said, int channels) {
  const std::string_view held = std::string_view("rgba").substr(0, channels ? size_t(channels) : 4);
  return std::any_of(said.maps.begin(), said.maps.end(),
                     [&](const DescribedMap& d) { return d.channels.find_first_not_of(held) != std::string::npos; });
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

std::vector<RecognisedMap> recognise_map(const MapFile& file, Stem* stem) {
  std::vector<RecognisedMap> named = recognise_name(file, stem);
  const std::optional<FileDescription> said = file_description(file.description);
  if (!said || !file.layer.empty() || needs_more_channels(*said, file.channels)) return named;
  const bool is_map_name = names_a_map(file.name, said->maps.front().semantic);
  if (stem && named.empty()) *stem = is_map_name ? Stem() : stem_in(without_extension(file.name));
  std::vector<RecognisedMap> maps;
  for (const DescribedMap& d : said->maps)
    maps.push_back({.map = d.name,
                    .semantic = d.semantic,
                    .file = file.name,
                    .channels = d.channels,
                    .inverted = d.inverted,
                    .normal_y = d.semantic == Semantic::normal ? said->normal_y : std::nullopt,
                    .color_space = said->color_space,
                    .said_by = "its description"});
  if (maps.size() > 1 || !maps.front().channels.empty()) return maps;
  // The file's name may know better which of several of that kind it is, and which way green points.
  RecognisedMap& only = maps.front();
  const bool agree = named.size() == 1 && named.front().semantic == only.semantic;
  if (agree && !only.normal_y) only.normal_y = named.front().normal_y;
  if (only.map != name_of(only.semantic)) return maps;
  if (agree)
    only.map = named.front().map;
  else if (is_map_name)
    only.map = without_extension(file.name);
  return maps;
}

std::string reason_to_skip(const std::string& name) {
  static const std::set<std::string> pictures = {"preview", "thumb",     "thumbnail", "sphere",      "render",
                                                 "icon",    "billboard", "swatch",    "contactsheet"};
  std::string glued;
  for (const NameWord& word : words_of_file(name)) {
    const std::string& w = word.text;
    if (pictures.count(without_digits(w))) return "a picture of the material, not a map";
    if (w.starts_with("mip") && w.size() > 3 && is_digit(w[3])) return "a level of a mip chain";
    if (w.starts_with("lod") && w.size() > 3 && is_digit(w[3]) && w != "lod0") return "a lower level of detail";
    glued += w;
  }
  for (const std::string_view other : {"worldspacenormal", "objectspacenormal", "bentnormal"})
    if (glued.find(other) != std::string::npos) return "its normals are not those of the surface in tangent space";
  return "";
}

namespace {

/// Leaves out the candidates of other materials than the one that is meant. False if it is not clear which that is.
bool keep_one_material(std::vector<Candidate>& candidates, const std::string& name, Recognition& out,
                       std::vector<FolderMaterial>& meant) {
  std::vector<StemmedMap> maps;
  for (const Candidate& c : candidates) maps.push_back({c.stem, c.map.map, c.map.semantic == Semantic::base_color});
  out.materials = materials_among(maps);
  meant = out.materials;
  if (name.empty()) return out.materials.size() <= 1;
  Stem of_file;
  recognise_map({.name = name + ".", .size = {}}, &of_file);
  meant = materials_named(out.materials, name, of_file);
  std::set<std::string> stems;
  for (const FolderMaterial& m : meant) stems.insert(m.stems.begin(), m.stems.end());
  std::erase_if(candidates, [&](const Candidate& c) { return !stems.count(c.stem.key()); });
  if (meant.size() == 1) out.name = meant.front().name;
  return !meant.empty();
}

/// Keeps files whose names say no map, of the materials that are meant, as data maps named after the rest of the name.
void keep_as_data(const std::vector<std::string>& patterns, const std::vector<FolderMaterial>& meant,
                  const std::vector<MapFile>& files, std::vector<Candidate>& candidates, Recognition& out) {
  const auto is_wanted = [&](const std::string& file) {
    return std::any_of(patterns.begin(), patterns.end(),
                       [&](const std::string& p) { return matches_pattern(file, p); }) &&
           (meant.empty() || meant.size() == out.materials.size() ||
            std::any_of(meant.begin(), meant.end(), [&](const FolderMaterial& m) { return may_belong_to(file, m); }));
  };
  for (const MapFile& f : files) {
    if (std::find(out.ignored.begin(), out.ignored.end(), shown(f)) == out.ignored.end() || !is_wanted(f.name))
      continue;
    std::erase(out.ignored, shown(f));
    RecognisedMap m{.map = "data_" + rest_of_name(f.telling_name(), out.materials),
                    .semantic = Semantic::data,
                    .file = f.name,
                    .channels = "",
                    .layer = f.layer};
    candidates.push_back({std::move(m), {}, 0, f.size.area(), lossiness_of(f.name)});
  }
}

}  // namespace

Recognition recognise_maps(std::vector<MapFile> files, const MapWishes& wishes) {
  std::sort(files.begin(), files.end(), [](const MapFile& a, const MapFile& b) { return a.name < b.name; });
  Recognition out;
  std::vector<Candidate> found = candidates_among(files, out);
  std::vector<FolderMaterial> meant;
  if (!keep_one_material(found, wishes.name, out, meant)) return out;
  keep_as_data(wishes.data, meant, files, found, out);
  std::map<std::string, int> stem_count;
  for (const Candidate& c : found) stem_count[c.stem.key()]++;
  const auto rank = [&](const Candidate& c) {
    return std::tuple(c.map.semantic, c.map.map, -stem_count[c.stem.key()], c.stand_in,
                      c.map.normal_y == NormalY::up ? 0 : 1, -c.area, c.lossiness, c.map.file, c.map.layer);
  };
  std::sort(found.begin(), found.end(), [&](const Candidate& a, const Candidate& b) { return rank(a) < rank(b); });

  const Candidate* chosen = nullptr;
  for (const Candidate& c : found) {
    if (chosen && chosen->map.map == c.map.map) {
      note_choice(*chosen, c.map, files, out);
      continue;
    }
    chosen = &c;
    out.maps.push_back(c.map);
    if (c.map.inverted) out.notes.push_back(fmt::format("roughness is {}, inverted", c.map.place()));
  }
  return out;
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
