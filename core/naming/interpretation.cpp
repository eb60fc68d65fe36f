#include "core/naming/interpretation.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "core/base/suggest.h"

namespace terrazzo {

namespace {

std::vector<std::string> words_for(Semantic semantic) {
  std::vector<std::string> words;
  if (semantic == Semantic::normal) words.assign(normal_channels_names.begin(), normal_channels_names.end());
  if (is_one_value(semantic)) words = {"inverted", "not_inverted"};
  if (semantic == Semantic::height) words.emplace_back("depth");
  words.insert(words.end(), {"as_stored", "as_tagged"});
  return words;
}

void add(const std::string& word, Semantic semantic, Interpretation& out) {
  const std::vector<std::string> known = words_for(semantic);
  if (std::ranges::find(known, word) == known.end())
    throw Error(fmt::format("expected {} for a {} map, found \"{}\"{}", fmt::join(known, ", "), name_of(semantic), word,
                            did_you_mean(word, known)));
  const auto normal = std::ranges::find(normal_channels_names, word);
  if (normal != normal_channels_names.end()) out.normal = NormalChannels(normal - normal_channels_names.begin());
  if (word.ends_with("inverted") || word == "depth") out.inverted = word != "not_inverted";
  if (word.starts_with("as_")) out.as_stored = word == "as_stored";
}

}  // namespace

Interpretation interpretation_from(std::string_view words, Semantic semantic) {
  Interpretation out;
  while (true) {
    const size_t comma = std::min(words.find(','), words.size());
    std::string word(words.substr(0, comma));
    std::erase(word, ' ');
    add(word, semantic, out);
    if (comma == words.size()) return out;
    words.remove_prefix(comma + 1);
  }
}

std::string advice_to_interpret(std::string_view map, std::string_view word) {
  if (map.empty()) return fmt::format("`interpret` \"{}\"", word);
  return fmt::format("`interpret` {{\"{0}\": \"{1}\"}} (of synth and new: --interpret {0}={1})", map, word);
}

}  // namespace terrazzo
