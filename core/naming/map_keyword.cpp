#include "core/naming/map_keyword.h"

#include <algorithm>

#include "core/naming/packing_names.h"

namespace terrazzo {

namespace {

/// Some names are glued to the next word: "normalgl", "heightmap", "normalmap".
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

/// Where a phrase stands.
struct PhrasePlace {
  bool is_last = false;   ///< only neutral words come after it
  bool is_first = false;  ///< no word comes before it
  bool is_whole = false;  ///< both
  bool is_glued = false;  ///< no separator between its words: metalRoughness
};

const MapWord* find_word(const Phrase& phrase, const PhrasePlace& place, bool has_digits, int channels) {
  const bool one_letter = phrase.text.size() <= 2;
  const bool begins_name = place.is_first && (!place.is_whole || one_letter);
  const bool digits_count = has_digits && (one_letter || place.is_first);
  for (const MapWord& w : map_words) {
    if (w.word != phrase.text || (channels && channels < w.least_channels)) continue;
    if (phrase.normal_y && w.parts[0].semantic != Semantic::normal) continue;
    if (w.strength != WordStrength::full && !place.is_last) continue;
    if (w.strength == WordStrength::initial && (begins_name || digits_count)) continue;
    return &w;
  }
  return nullptr;
}

/// Short words for maps may be part of an asset's name: rusty_metal_rough_ao has no metallic channel.
std::vector<WordPart> find_packing(const std::string& phrase, const PhrasePlace& place, int channels) {
  PackingName found = packing_in(phrase);
  if (found.parts.empty() || (channels && channels < found.least_channels)) return {};
  if (found.all_full_words) return found.parts;
  const bool is_list = found.begins_with_full && (found.parts.size() > 2 || found.parts.back().inverted);
  const bool counts = place.is_last && (place.is_glued || is_list) && (!place.is_first || found.has_full_word);
  return counts ? found.parts : std::vector<WordPart>{};
}

bool are_glued(const std::vector<NameWord>& words, size_t first, size_t last) {
  for (size_t i = first; i + 1 < last; i++)
    if (words[i].end != words[i + 1].begin) return false;
  return true;
}

/// The convention may stand beside the word for normal: normal_gl, nor_dx, gl_normal, normal_2k_directx.
std::optional<NormalY> convention_beside(const std::vector<NameWord>& words, const KeywordMatch& m) {
  for (size_t i = m.last; i < words.size(); i++) {
    if (const auto found = convention(words[i].text)) return found;
    if (i + 1 < words.size())
      if (const auto found = convention(words[i].text + words[i + 1].text)) return found;
  }
  if (m.first > 0) return convention(words[m.first - 1].text);
  return std::nullopt;
}

size_t end_of_name(const std::vector<NameWord>& words) {
  size_t end = words.size();
  while (end > 0 && is_neutral(words[end - 1].text)) end--;
  return end;
}

/// The last keyword of words [0, end).
KeywordMatch find_before(const std::vector<NameWord>& words, size_t end, size_t named, int channels) {
  constexpr size_t longest_phrase = 4;
  for (size_t last = end; last > 0; last--)
    for (size_t first = last > longest_phrase ? last - longest_phrase : 0; first < last; first++) {
      std::string phrase;
      for (size_t i = first; i < last; i++) phrase += words[i].text;
      const PhrasePlace place{.is_last = last >= named,
                              .is_first = first == 0,
                              .is_whole = first == 0 && last >= named,
                              .is_glued = are_glued(words, first, last)};
      const std::string bare = without_digits(phrase);
      for (const Phrase& reading : readings(bare)) {
        if (std::vector<WordPart> packing = find_packing(reading.text, place, channels); !packing.empty())
          return {std::move(packing), first, last, std::nullopt};
        if (const MapWord* w = find_word(reading, place, bare != phrase, channels))
          return {{w->parts.begin(), w->parts.begin() + w->part_count}, first, last, reading.normal_y};
      }
    }
  return {};
}

bool is_one_map(const KeywordMatch& m) {
  return m.parts.size() == 1 && m.parts.front().channels.empty() && m.parts.front().map.empty();
}

bool may_fill_alpha(Semantic s) {
  using enum Semantic;
  return s == height || s == roughness || s == metallic || s == ambient_occlusion || s == opacity;
}
bool fills_rgb(Semantic s) {
  return s == Semantic::base_color || s == Semantic::normal || s == Semantic::specular || s == Semantic::emission;
}

/// In a file with alpha (albedo_height, nrm_rgh) the first map is in red, green and blue, the second in alpha.
void take_in_rgb(const std::vector<NameWord>& words, KeywordMatch& alpha) {
  if (!is_one_map(alpha) || !may_fill_alpha(alpha.parts.front().semantic)) return;
  const KeywordMatch rgb = find_before(words, alpha.first, alpha.first, 4);
  if (!is_one_map(rgb) || rgb.last != alpha.first || !fills_rgb(rgb.parts.front().semantic)) return;
  alpha.parts.insert(alpha.parts.begin(), rgb.parts.front());
  alpha.parts[0].channels = "rgb";
  alpha.parts[1].channels = "a";
  alpha.first = rgb.first;
  alpha.normal_y = rgb.normal_y;
}

}  // namespace

KeywordMatch find_keyword(const std::vector<NameWord>& words, int channels) {
  KeywordMatch found = find_before(words, words.size(), end_of_name(words), channels);
  if (!found) return {};
  if (channels == 4) take_in_rgb(words, found);
  if (!found.normal_y) found.normal_y = convention_beside(words, found);
  return found;
}

KeywordMatch normals_by_convention(const std::vector<NameWord>& words, int channels) {
  if (channels == 1) return {};
  for (size_t i = words.size(); i-- > 1 && is_neutral(words[i].text);)
    if (const auto found = convention(words[i].text); found && words[i].text != "gl")
      return {{WordPart{Semantic::normal, "", ""}}, i, i + 1, found};
  return {};
}

int further_words(const std::vector<NameWord>& words, const KeywordMatch& match) {
  return int(std::count_if(words.begin() + ptrdiff_t(match.last), words.end(),
                           [](const NameWord& w) { return !is_neutral(w.text); }));
}

std::vector<NameWord> without_workflow(std::vector<NameWord> words, int channels) {
  if (words.size() < 3 || !is_resolution(words[words.size() - 2].text)) return words;
  if (words.back().text != "metalness" && words.back().text != "specular") return words;
  const std::vector<NameWord> before(words.begin(), words.end() - 2);
  if (find_keyword(before, channels).last == before.size()) words.pop_back();
  return words;
}

}  // namespace terrazzo
