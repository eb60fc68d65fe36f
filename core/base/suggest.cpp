#include "core/base/suggest.h"

#include <algorithm>

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

/// Without what people leave out or put in between words.
std::string letters_of(std::string_view name) {
  std::string out = lowercase(name);
  std::erase_if(out, [](char c) { return c == '_' || c == '-' || c == ' '; });
  return out;
}

/// One is the other's beginning, as in "bool" and "boolean".
bool is_short_form(std::string_view a, std::string_view b) {
  const size_t shared = std::min(a.size(), b.size());
  return shared >= 3 && a.substr(0, shared) == b.substr(0, shared);
}

}  // namespace

std::string nearest(std::string_view wrong, const std::vector<std::string>& names) {
  constexpr size_t longest = 64;
  if (wrong.empty() || wrong.size() > longest) return "";
  const std::string letters = letters_of(wrong);
  const auto same = std::ranges::find_if(
      names, [&](const std::string& name) { return name != wrong && letters_of(name) == letters; });
  if (same != names.end() && !letters.empty()) return *same;
  const std::string typed = lowercase(wrong);
  std::string best;
  size_t least = (typed.size() + 2) / 3 + 1;
  for (const std::string& name : names) {
    if (name == wrong) continue;
    const std::string known = lowercase(name);
    const size_t distance = edit_distance(typed, known, least);
    if (distance < least && distance < std::max(typed.size(), known.size())) {
      least = distance;
      best = name;
    }
  }
  if (!best.empty()) return best;
  const auto at = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
    return name != wrong && is_short_form(typed, lowercase(name));
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
  std::vector<std::string> names;
  for (const std::string& name : all)
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
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
