#include "core/material/material_files.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/material/map_words.h"

namespace terrazzo {

namespace {

bool is_upper(char c) {
  return c >= 'A' && c <= 'Z';
}
bool is_lower(char c) {
  return c >= 'a' && c <= 'z';
}

std::string extension_of(const std::string& name) {
  const size_t dot = name.rfind('.');
  return dot == std::string::npos ? "" : lowercase(name.substr(dot + 1));
}

/// The words of a name in lower case: cut at everything that is no letter or digit, and where camel case begins a word
/// (NormalGL -> normal, gl; AOMap -> ao, map).
std::vector<std::string> words_of(const std::string& name) {
  const std::string stem = name.substr(0, name.rfind('.'));
  std::vector<std::string> words(1);
  for (size_t i = 0; i < stem.size(); i++) {
    const char c = stem[i], before = i ? stem[i - 1] : '_', after = i + 1 < stem.size() ? stem[i + 1] : '_';
    const bool part_of_word = is_digit(c) || is_upper(c) || is_lower(c) || static_cast<unsigned char>(c) >= 128;
    const bool camel = is_upper(c) && (is_lower(before) || (is_upper(before) && is_lower(after)) ||
                                       (is_digit(before) && is_lower(after)));
    if (!part_of_word || camel)
      if (!words.back().empty()) words.emplace_back();
    if (part_of_word) words.back() += c;
  }
  if (words.back().empty()) words.pop_back();
  for (std::string& w : words) w = lowercase(w);
  return words;
}

std::optional<NormalY> convention(std::string_view word) {
  if (word == "gl" || word == "ogl" || word == "opengl") return NormalY::up;
  if (word == "dx" || word == "directx" || word == "d3d") return NormalY::down;
  return std::nullopt;
}

/// Words that say nothing about which map it is: sizes, versions, formats, colour spaces, normal conventions.
bool is_neutral(const std::string& word) {
  static const std::set<std::string> known = {
      "jpg", "jpeg", "png", "tif",   "tiff",   "exr",      "tga",    "map",      "tex", "texture", "image",
      "img", "srgb", "raw", "lin",   "linear", "rec709",   "acescg", "utility",  "var", "open",    "direct",
      "x",   "u",    "v",   "final", "copy",   "seamless", "tile",   "tileable", "sml", "lod0"};
  if (is_digit(word[0]) || known.count(word) || convention(word)) return true;
  // u1, v1, var2, v02
  const size_t digits = word.find_first_of("0123456789");
  return digits != std::string::npos && digits <= 3 && known.count(word.substr(0, digits));
}

std::string without_digits(const std::string& word) {
  size_t begin = 0, end = word.size();
  while (begin < end && is_digit(word[begin])) begin++;
  while (end > begin && is_digit(word[end - 1])) end--;
  return word.substr(begin, end - begin);
}

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

Telling find_telling(const std::vector<std::string>& words, int channels) {
  constexpr size_t longest_phrase = 4;
  size_t end_of_name = words.size();  // neutral words at the end aside
  while (end_of_name > 0 && is_neutral(words[end_of_name - 1])) end_of_name--;
  for (size_t last = words.size(); last > 0; last--)
    for (size_t first = last > longest_phrase ? last - longest_phrase : 0; first < last; first++) {
      std::string phrase;
      for (size_t i = first; i < last; i++) phrase += words[i];
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

/// The convention may stand beside the word for normal: normal_gl, nor_dx, gl_normal, normal_2k_directx.
std::optional<NormalY> convention_beside(const std::vector<std::string>& words, const Telling& t) {
  for (size_t i = t.last; i < words.size(); i++) {
    if (const auto found = convention(words[i])) return found;
    if (i + 1 < words.size())
      if (const auto found = convention(words[i] + words[i + 1])) return found;
  }
  if (t.first > 0) return convention(words[t.first - 1]);
  return std::nullopt;
}

/// A recognised map with what decides between it and others of the same name; smaller is better.
struct Candidate {
  RecognisedMap map;
  std::string prefix;
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
  const std::vector<std::string> words = words_of(file);
  return std::any_of(words.begin(), words.end(), [](const std::string& w) { return without_digits(w) == "bump"; });
}

std::string described(const RecognisedMap& m) {
  return m.channels.empty() ? m.file : fmt::format("{} (channel {})", m.file, m.channels);
}

std::string size_text(const std::vector<MapFile>& files, const std::string& name) {
  for (const MapFile& f : files)
    if (f.name == name && f.size.area() > 0) return fmt::format(" ({}x{})", f.size.width, f.size.height);
  return "";
}

void note_choice(const Candidate& chosen, const RecognisedMap& passed_over, const std::vector<MapFile>& files,
                 Recognition& out) {
  const RecognisedMap& taken = chosen.map;
  if (taken.semantic == Semantic::normal && taken.normal_y == NormalY::up && passed_over.normal_y == NormalY::down)
    out.notes.push_back(fmt::format("normal is {} (OpenGL); {} (DirectX) left out", taken.file, passed_over.file));
  else
    out.notes.push_back(fmt::format("{} is {}{}; {}{} left out", taken.map, described(taken),
                                    size_text(files, taken.file), described(passed_over),
                                    size_text(files, passed_over.file)));
}

std::vector<Candidate> candidates_among(const std::vector<MapFile>& files, Recognition& out) {
  std::vector<Candidate> found;
  for (const MapFile& f : files) {
    const std::string reason = reason_to_skip(f.name);
    if (!reason.empty()) {
      out.notes.push_back(fmt::format("{} left out: {}", f.name, reason));
      continue;
    }
    std::string prefix;
    const std::vector<RecognisedMap> maps = recognise_map(f, &prefix);
    if (maps.empty()) out.ignored.push_back(f.name);
    for (const RecognisedMap& m : maps) {
      const bool stands_in = m.inverted || (m.semantic == Semantic::height && is_bump(m.file));
      found.push_back({m, prefix, stands_in ? 2 : m.channels.empty() ? 0 : 1, f.size.area(), lossiness_of(f.name)});
    }
  }
  return found;
}

}  // namespace

std::vector<RecognisedMap> recognise_map(const MapFile& file, std::string* prefix) {
  const std::vector<std::string> words = words_of(file.name);
  const Telling t = find_telling(words, file.channels);
  if (!t.word) return {};
  if (prefix) {
    prefix->clear();
    for (size_t i = 0; i < t.first; i++)
      if (!is_neutral(words[i])) *prefix += words[i] + "_";
  }
  std::vector<RecognisedMap> maps;
  for (int i = 0; i < t.word->part_count; i++) {
    const WordPart& part = t.word->parts[i];
    RecognisedMap m;
    m.map = part.map.empty() ? name_of(part.semantic) : part.map;
    m.semantic = part.semantic;
    m.file = file.name;
    m.channels = part.channels;
    m.inverted = part.inverted;
    if (part.semantic == Semantic::normal) m.normal_y = t.normal_y ? t.normal_y : convention_beside(words, t);
    maps.push_back(std::move(m));
  }
  return maps;
}

std::string reason_to_skip(const std::string& name) {
  static const std::set<std::string> pictures = {"preview", "thumb",     "thumbnail", "sphere",      "render",
                                                 "icon",    "billboard", "swatch",    "contactsheet"};
  for (const std::string& w : words_of(name)) {
    if (pictures.count(without_digits(w))) return "a picture of the material, not a map";
    if (w.starts_with("lod") && w.size() > 3 && is_digit(w[3]) && w != "lod0") return "a lower level of detail";
  }
  return "";
}

Recognition recognise_maps(std::vector<MapFile> files) {
  std::sort(files.begin(), files.end(), [](const MapFile& a, const MapFile& b) { return a.name < b.name; });
  Recognition out;
  std::vector<Candidate> found = candidates_among(files, out);
  std::map<std::string, int> prefix_count;
  for (const Candidate& c : found) prefix_count[c.prefix]++;
  const auto rank = [&](const Candidate& c) {
    return std::tuple(c.map.semantic, c.map.map, -prefix_count[c.prefix], c.stand_in,
                      c.map.normal_y == NormalY::up ? 0 : 1, -c.area, c.lossiness, c.map.file);
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
    if (c.map.inverted) out.notes.push_back(fmt::format("roughness is {}, inverted", described(c.map)));
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

namespace {

/// Both in lower case.
bool matches(std::string_view name, std::string_view pattern) {
  if (pattern.empty()) return name.empty();
  if (pattern[0] == '*') return matches(name, pattern.substr(1)) || (!name.empty() && matches(name.substr(1), pattern));
  if (name.empty()) return false;
  return (pattern[0] == '?' || pattern[0] == name[0]) && matches(name.substr(1), pattern.substr(1));
}

}  // namespace

bool matches_pattern(std::string_view name, std::string_view pattern) {
  return matches(lowercase(name), lowercase(pattern));
}

}  // namespace terrazzo
