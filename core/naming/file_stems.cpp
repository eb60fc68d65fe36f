#include "core/naming/file_stems.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "core/base/text.h"

namespace terrazzo {

namespace {

int number_in(std::string_view text) {
  int number = -1;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  return failure == std::errc() && end == text.data() + text.size() ? number : -1;
}

/// The UDIM tile in a name, apart from the words [first, last) for the map: 1001 to 1099 as the last word that is not
/// neutral, or Mudbox's u1_v1.
std::optional<int> tile_of(std::vector<NameWord> words, size_t first, size_t last) {
  words.erase(words.begin() + ptrdiff_t(first), words.begin() + ptrdiff_t(last));
  for (size_t i = words.size(); i > 0; i--) {
    const std::string& word = words[i - 1].text;
    const int number = word.size() == 4 ? number_in(word) : -1;
    if (number >= 1001 && number <= 1099) return number;
    if (i > 1 && word[0] == 'v' && words[i - 2].text[0] == 'u') {
      const int u = number_in(std::string_view(words[i - 2].text).substr(1));
      const int v = number_in(std::string_view(word).substr(1));
      if (u > 0 && u <= 10 && v > 0) return 1001 + (u - 1) + 10 * (v - 1);
    }
    if (!is_neutral(word)) break;
  }
  return std::nullopt;
}

/// Where the tile's word stands in a material's name.
std::optional<NameWord> udim_word(std::string_view name) {
  const std::vector<NameWord> words = words_in(name);
  if (words.empty() || tile_of({words.back()}, 0, 0) != number_in(words.back().text)) return std::nullopt;
  return words.back();
}

bool is_tile(const std::string& word, const std::optional<int>& tile) {
  return tile && word == std::to_string(*tile);
}

/// Adds the words of [begin, end) that identify the material.
void add_words(Stem& stem, std::string_view name, const std::vector<NameWord>& words, size_t begin, size_t end,
               bool (*is_left_out)(const std::string&), const std::optional<int>& tile) {
  size_t from = 0, to = 0;
  for (size_t i = begin; i < end; i++) {
    if (is_left_out(words[i].text) || is_tile(words[i].text, tile)) continue;
    if (stem.words.empty()) from = words[i].begin;
    to = words[i].end;
    stem.words.push_back(words[i].text);
  }
  stem.shown = std::string(name.substr(from, to - from));
}

/// One stem with its maps.
struct Group {
  Stem stem;
  std::set<std::string> maps;
  int files = 0;
  bool has_color = false;
};

bool share_a_map(const Group& a, const Group& b) {
  return std::any_of(a.maps.begin(), a.maps.end(), [&](const std::string& m) { return b.maps.count(m); });
}

/// Whether the words of one stem are among those of the other; `more` receives those that only one has.
bool are_related(const Stem& a, const Stem& b, std::set<std::string>& more) {
  const std::set<std::string> in_a(a.words.begin(), a.words.end()), in_b(b.words.begin(), b.words.end());
  more.clear();
  std::set_symmetric_difference(in_a.begin(), in_a.end(), in_b.begin(), in_b.end(), std::inserter(more, more.end()));
  return std::includes(in_a.begin(), in_a.end(), in_b.begin(), in_b.end()) ||
         std::includes(in_b.begin(), in_b.end(), in_a.begin(), in_a.end());
}

bool belong_together(const Group& a, const Group& b) {
  std::set<std::string> more;
  if (!are_related(a.stem, b.stem, more) || (a.has_color && b.has_color)) return false;
  if (!share_a_map(a, b)) return true;
  if (!is_extension(a.stem, b.stem)) return false;
  const bool numbered = std::any_of(more.begin(), more.end(),
                                    [](const std::string& w) { return std::all_of(w.begin(), w.end(), is_digit); });
  return !numbered && a.has_color != b.has_color;
}

std::vector<Group> grouped(const std::vector<StemmedMap>& maps) {
  std::map<std::string, Group> by_key;
  for (const StemmedMap& m : maps) {
    Group& group = by_key[m.stem.key()];
    // The alphabetically first spelling, so that the order of files does not matter.
    if (group.files == 0 || m.stem.shown < group.stem.shown) group.stem = m.stem;
    group.files++;
    group.maps.insert(m.map);
    group.has_color |= m.is_color;
  }
  std::vector<Group> groups;
  for (auto& [key, group] : by_key) groups.push_back(std::move(group));
  std::stable_sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) {
    return std::tuple(!a.has_color, -a.files) < std::tuple(!b.has_color, -b.files);
  });
  return groups;
}

bool says_no_material_nor_filler(const std::string& word) {
  return says_no_material(word) && !is_filler(word);
}

std::vector<std::string> words_of_material(std::string_view file, bool (*is_left_out)(const std::string&)) {
  std::vector<std::string> words;
  for (const NameWord& w : words_of_file(file))
    if (!is_left_out(w.text)) words.push_back(w.text);
  return words;
}

/// The number of words at the beginning that make up the stem; 0 if none do.
size_t words_in_stem(const std::vector<std::string>& words, const std::string& key) {
  std::string joined;
  for (size_t i = 0; i < words.size(); i++) {
    joined += words[i];
    if (joined == key) return i + 1;
  }
  return 0;
}

}  // namespace

std::string Stem::key() const {
  std::string key;
  for (const std::string& w : words) key += w;
  return key;
}

Stem stem_of(std::string_view name, const std::vector<NameWord>& words, size_t first, size_t last, Fillers fillers) {
  const std::optional<int> tile = tile_of(words, first, last);
  Stem stem;
  add_words(stem, name, words, 0, first, fillers == Fillers::kept ? says_no_material_nor_filler : says_no_material,
            tile);
  if (stem.words.empty()) add_words(stem, name, words, last, words.size(), is_neutral, tile);
  if (tile) {
    stem.words.push_back(std::to_string(*tile));
    stem.shown += (stem.shown.empty() ? "" : ".") + stem.words.back();
  }
  return stem;
}

Stem stem_in(std::string_view text, Fillers fillers) {
  const std::vector<NameWord> words = words_in(text);
  return stem_of(text, words, words.size(), words.size(), fillers);
}

bool is_extension(const Stem& a, const Stem& b) {
  const auto& [shorter, longer] =
      a.words.size() < b.words.size() ? std::tie(a.words, b.words) : std::tie(b.words, a.words);
  return std::equal(shorter.begin(), shorter.end(), longer.begin());
}

std::vector<FolderMaterial> materials_among(const std::vector<StemmedMap>& maps) {
  const std::vector<Group> groups = grouped(maps);
  std::vector<const Group*> heads;
  std::vector<FolderMaterial> materials;
  for (const Group& group : groups) {
    std::vector<size_t> fitting;
    for (size_t i = 0; i < heads.size(); i++)
      if (belong_together(*heads[i], group)) fitting.push_back(i);
    if (fitting.size() != 1) {
      heads.push_back(&group);
      materials.push_back({group.stem.shown, {group.stem.key()}, {group.maps.begin(), group.maps.end()}});
      continue;
    }
    FolderMaterial& material = materials[fitting.front()];
    material.stems.push_back(group.stem.key());
    for (const std::string& m : group.maps)
      if (std::find(material.maps.begin(), material.maps.end(), m) == material.maps.end()) material.maps.push_back(m);
  }
  std::sort(materials.begin(), materials.end(),
            [](const FolderMaterial& a, const FolderMaterial& b) { return a.name < b.name; });
  return materials;
}

MeantMaterials materials_named(const std::vector<FolderMaterial>& all, const std::string& name,
                               const std::vector<Stem>& file_stems) {
  const bool is_pattern = name.find_first_of("*?") != std::string::npos;
  const auto chosen_by = [&](const auto& is_meant) {
    std::vector<FolderMaterial> chosen;
    std::copy_if(all.begin(), all.end(), std::back_inserter(chosen), is_meant);
    return chosen;
  };
  if (is_pattern) return {chosen_by([&](const FolderMaterial& m) { return matches_pattern(m.name, name); })};
  std::vector<std::string> keys = {stem_in(name, Fillers::kept).key(), stem_in(name).key()};
  for (const Stem& s : file_stems) keys.push_back(s.key());
  for (const std::string& key : keys) {
    if (key.empty()) continue;
    auto chosen = chosen_by(
        [&](const FolderMaterial& m) { return std::find(m.stems.begin(), m.stems.end(), key) != m.stems.end(); });
    if (!chosen.empty()) return {std::move(chosen), key};
  }
  return {};
}

std::string udim_tile_of(std::string_view name) {
  const std::optional<NameWord> word = udim_word(name);
  return word ? word->text : "";
}

std::string without_udim_tile(std::string_view name) {
  const std::optional<NameWord> word = udim_word(name);
  if (!word) return std::string(name);
  std::string rest(name.substr(0, word->begin));
  while (!rest.empty() && (rest.back() == '_' || !is_word(rest.back()))) rest.pop_back();
  return rest;
}

bool may_belong_to(std::string_view file, const FolderMaterial& material) {
  const auto begins_with = [&](const std::vector<std::string>& words) {
    return std::any_of(material.stems.begin(), material.stems.end(),
                       [&](const std::string& key) { return key.empty() || words_in_stem(words, key) > 0; });
  };
  return begins_with(words_of_material(file, says_no_material)) ||
         begins_with(words_of_material(file, says_no_material_nor_filler));
}

std::string rest_of_name(std::string_view file, const std::vector<FolderMaterial>& materials) {
  const auto said_of = [&](const std::vector<std::string>& words) {
    size_t said = 0;
    for (const FolderMaterial& m : materials)
      for (const std::string& key : m.stems) said = std::max(said, words_in_stem(words, key));
    return said;
  };
  std::vector<std::string> words = words_of_material(file, says_no_material);
  size_t said = said_of(words);
  if (said == 0) {
    words = words_of_material(file, says_no_material_nor_filler);
    said = said_of(words);
    if (said == 0) words = words_of_material(file, says_no_material);
  }
  if (said == words.size()) said = 0;
  std::string rest;
  for (size_t i = said; i < words.size(); i++) rest += (rest.empty() ? "" : "_") + words[i];
  return rest;
}

}  // namespace terrazzo
