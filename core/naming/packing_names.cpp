#include "core/naming/packing_names.h"

#include <algorithm>
#include <array>
#include <optional>

namespace terrazzo {

namespace {

struct ListedWord {
  std::string_view word;
  Semantic semantic;
  bool inverted = false;
  bool full = true;
};

/// A word comes before its own prefixes.
constexpr std::array listed_words = {
    ListedWord{"ambientocclusion", Semantic::ambient_occlusion},
    ListedWord{"occlusion", Semantic::ambient_occlusion},
    ListedWord{"occ", Semantic::ambient_occlusion, false, false},
    ListedWord{"ao", Semantic::ambient_occlusion},
    ListedWord{"roughness", Semantic::roughness},
    ListedWord{"rough", Semantic::roughness, false, false},
    ListedWord{"rgh", Semantic::roughness, false, false},
    ListedWord{"smoothness", Semantic::roughness, true},
    ListedWord{"smooth", Semantic::roughness, true, false},
    ListedWord{"glossiness", Semantic::roughness, true},
    ListedWord{"gloss", Semantic::roughness, true, false},
    ListedWord{"metallic", Semantic::metallic},
    ListedWord{"metalness", Semantic::metallic},
    ListedWord{"metal", Semantic::metallic, false, false},
    ListedWord{"met", Semantic::metallic, false, false},
    ListedWord{"height", Semantic::height},
    ListedWord{"displacement", Semantic::height},
    ListedWord{"disp", Semantic::height, false, false},
    ListedWord{"opacity", Semantic::opacity},
};

std::vector<ListedWord> words_listed(std::string_view text) {
  std::vector<ListedWord> words;
  while (!text.empty()) {
    const auto word = std::ranges::find_if(listed_words, [&](const ListedWord& w) { return text.starts_with(w.word); });
    if (word == listed_words.end()) return {};
    words.push_back(*word);
    text.remove_prefix(word->word.size());
  }
  return words;
}

bool are_distinct(const std::vector<ListedWord>& words) {
  for (size_t i = 0; i < words.size(); i++)
    for (size_t k = 0; k < i; k++)
      if (words[i].semantic == words[k].semantic) return false;
  return true;
}

/// One channel for each word; empty if no program uses such a list.
std::string_view channels_of(const std::vector<ListedWord>& words) {
  const auto place = [&](Semantic s) { return std::ranges::find(words, s, &ListedWord::semantic) - words.begin(); };
  const auto count = std::ssize(words);
  const ptrdiff_t roughness = place(Semantic::roughness), metallic = place(Semantic::metallic);
  if (!are_distinct(words) || roughness == count || count > 4) return "";
  if (count != 2) return count == 3 ? "rgb" : count == 4 ? "rgba" : "";
  if (metallic == count) return "";
  if (words[size_t(roughness)].inverted) return metallic == 0 ? "ra" : "";
  return metallic == 0 ? "bg" : "gb";
}

}  // namespace

PackingName packing_in(std::string_view text) {
  const std::vector<ListedWord> words = words_listed(text);
  if (words.size() < 2) return {};
  const std::string_view channels = channels_of(words);
  if (channels.empty()) return {};
  PackingName out;
  for (size_t i = 0; i < words.size(); i++)
    out.parts.push_back({words[i].semantic, "", channels.substr(i, 1), words[i].inverted});
  out.least_channels = channels.find('a') != channels.npos ? 4 : 3;
  out.has_full_word = std::ranges::any_of(words, &ListedWord::full);
  out.all_full_words = std::ranges::all_of(words, &ListedWord::full);
  out.begins_with_full = words.front().full;
  return out;
}

}  // namespace terrazzo
