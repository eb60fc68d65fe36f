#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace terrazzo {

/// Converts A to Z to lower case; everything else, including UTF-8, stays.
inline std::string lowercase(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

inline bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
inline bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
/// Letters, digits and "_": the characters of names in graphs.
inline bool is_word(char c) {
  return is_digit(c) || is_letter(c) || c == '_';
}

/// Whether a name matches a pattern with the wildcards * and ?; case-insensitive.
inline bool matches_pattern(std::string_view name, std::string_view pattern) {
  const std::string text = lowercase(name), wanted = lowercase(pattern);
  size_t at = 0, next = 0, after_star = std::string::npos, star_ends = 0;
  while (at < text.size()) {
    if (next < wanted.size() && wanted[next] == '*') {
      after_star = ++next;
      star_ends = at;
    } else if (next < wanted.size() && (wanted[next] == '?' || wanted[next] == text[at])) {
      at++;
      next++;
    } else if (after_star != std::string::npos) {  // the last star matches one more character
      at = ++star_ends;
      next = after_star;
    } else {
      return false;
    }
  }
  return wanted.find_first_not_of('*', next) == std::string::npos;
}

/// Escapes a text for HTML and SVG, between tags or in a quoted attribute.
inline std::string markup(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '&')
      out += "&amp;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

/// "1 file", "3 files"; for regular plurals.
inline std::string counted(int64_t count, std::string_view thing) {
  return std::to_string(count).append(" ").append(thing).append(count == 1 ? "" : "s");
}

/// The prefix of notes that are warnings.
inline constexpr std::string_view warning_mark = "warning: ";
inline bool is_warning(std::string_view note) {
  return note.starts_with(warning_mark);
}

}  // namespace terrazzo
