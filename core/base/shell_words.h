#pragma once

#include <algorithm>
#include <cctype>
#include <string>

namespace terrazzo {

/// Quotes a word for a shell if necessary.
inline std::string shell_word(const std::string& word) {
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) || std::string_view("_-./:=,+@%").find(char(c)) != std::string_view::npos;
  };
  if (!word.empty() && std::ranges::all_of(word, is_plain)) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

}  // namespace terrazzo
