#include "core/base/suggest.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/base/text.h"

namespace terrazzo {

namespace {

/// Insertions, deletions, replacements and swaps of neighbours that turn `a` into `b`; anything above `limit` counts as
/// limit + 1. (Optimal string alignment, three rolling rows.)
size_t edit_distance(std::string_view a, std::string_view b, size_t limit) {
  if (std::max(a.size(), b.size()) - std::min(a.size(), b.size()) > limit) return limit + 1;
  std::vector<size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); j++) above[j] = j;
  for (size_t i = 1; i <= a.size(); i++) {
    row[0] = i;
    size_t least = i;
    for (size_t j = 1; j <= b.size(); j++) {
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
      least = std::min(least, row[j]);
    }
    if (least > limit) return limit + 1;
    before.swap(above);
    above.swap(row);
  }
  return above[b.size()];
}

/// Without separators between words.
std::string letters_of(std::string_view name) {
  std::string out = lowercase(name);
  std::erase_if(out, [](char c) { return c == '_' || c == '-' || c == ' '; });
  return out;
}

/// Whether one name is a sufficiently long prefix of the other, as "bool" of "boolean".
bool is_short_form(std::string_view a, std::string_view b) {
  const size_t shared = std::min(a.size(), b.size());
  return shared >= 3 && 3 * shared >= std::max(a.size(), b.size()) && a.substr(0, shared) == b.substr(0, shared);
}

/// The most typing errors in a word of this length; with more, another word is meant.
size_t most_mistakes(size_t letters) {
  if (letters < 3) return 0;
  return letters < 6 ? 1 : letters < 12 ? 2 : 3;
}

/// The ending of a file's name, ".png"; empty if there is none.
std::string_view ending_of(std::string_view name) {
  const size_t dot = name.rfind('.');
  return dot == name.npos || dot == 0 ? "" : name.substr(dot);
}

/// Numbers that differ are chosen, not misspelt.
bool have_other_numbers(std::string_view a, std::string_view b) {
  const auto number_in = [](std::string_view name) {
    std::string digits;
    for (const char c : name)
      if (is_digit(c) && !(digits.empty() && c == '0')) digits += c;
    return digits;
  };
  const auto is_number = [](char c) { return is_digit(c); };
  return std::ranges::any_of(a, is_number) && std::ranges::any_of(b, is_number) && number_in(a) != number_in(b);
}

/// A phonetic form: "delite" is meant as "delight".
std::string sounds_of(std::string name) {
  for (const auto& [spelt, sounds] : {std::pair("ph", "f"), std::pair("ght", "t")})
    for (size_t at; (at = name.find(spelt)) != std::string::npos;) name.replace(at, std::strlen(spelt), sounds);
  return name;
}

/// The typing errors between two names; nullopt if there are too many. A common extension does not count as similarity.
std::optional<size_t> mistakes(std::string_view typed, std::string_view known) {
  if (const std::string_view ending = ending_of(typed); !ending.empty() && ending == ending_of(known)) {
    typed.remove_suffix(ending.size());
    known.remove_suffix(ending.size());
  }
  if (have_other_numbers(typed, known)) return std::nullopt;
  const size_t most = most_mistakes(std::min(typed.size(), known.size()));
  const size_t distance = edit_distance(typed, known, most);
  return distance <= most ? std::optional(distance) : std::nullopt;
}

}  // namespace

std::string nearest(std::string_view wrong, const std::vector<std::string>& names) {
  constexpr size_t longest = 64;
  if (wrong.empty() || wrong.size() > longest) return "";
  const std::string letters = letters_of(wrong);
  const auto same = std::ranges::find_if(
      names, [&](const std::string& name) { return name != wrong && letters_of(name) == letters; });
  if (same != names.end() && !letters.empty()) return *same;
  const std::string typed = lowercase(wrong), sounds = sounds_of(typed);
  std::string best;
  std::optional<size_t> least;
  for (const std::string& name : names) {
    if (name == wrong) continue;
    std::optional<size_t> found = mistakes(typed, lowercase(name));
    if (!found) found = mistakes(sounds, sounds_of(lowercase(name)));
    if (!found || (least && *found >= *least)) continue;
    least = found;
    best = name;
  }
  if (!best.empty()) return best;
  const auto at = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
    return name != wrong && is_short_form(sounds, sounds_of(lowercase(name)));
  });
  return at == names.end() ? "" : *at;
}

std::string did_you_mean(std::string_view wrong, const std::vector<std::string>& names) {
  const std::string best = nearest(wrong, names);
  return best.empty() ? "" : fmt::format(" (did you mean \"{}\"?)", best);
}

std::string suggestion(std::string_view wrong, const std::vector<std::string>& names) {
  if (std::string question = did_you_mean(wrong, names); !question.empty()) return question;
  return names.empty() ? "" : fmt::format(" (valid: {})", listed(names));
}

std::string listed(const std::vector<std::string>& all) {
  std::vector<std::string_view> names;
  std::set<std::string_view> seen;
  for (const std::string& name : all)
    if (seen.insert(name).second) names.push_back(name);
  constexpr size_t most = 16;
  const size_t shown = std::min(names.size(), most);
  std::string text;
  for (size_t i = 0; i < shown; i++) {
    const bool last = i + 1 == names.size();
    text += fmt::format("{}\"{}\"", i == 0 ? "" : last ? " or " : ", ", names[i]);
  }
  return shown < names.size() ? text + fmt::format(" and {} more", names.size() - shown) : text;
}

}  // namespace terrazzo
