#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace terrazzo {

/// With A to Z made small; everything else, UTF-8 included, stays.
inline std::string lowercase(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

/// "1 file", "3 files": of things with a plain plural.
inline std::string counted(int64_t count, std::string_view thing) {
  return std::to_string(count).append(" ").append(thing).append(count == 1 ? "" : "s");
}

/// How notes begin that are warnings.
inline constexpr std::string_view warning_mark = "warning: ";
inline bool is_warning(std::string_view note) {
  return note.starts_with(warning_mark);
}

}  // namespace terrazzo
