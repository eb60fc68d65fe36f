#pragma once

#include <string>
#include <string_view>

namespace terrazzo {

/// Escapes control characters as \xNN, except line ends and tabs: on a terminal they could do anything.
inline std::string printable(std::string_view text) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string out;
  for (size_t i = 0; i < text.size(); i++) {
    const auto code = static_cast<unsigned char>(text[i]);
    const bool is_c1 = code == 0xc2 && i + 1 < text.size() && (static_cast<unsigned char>(text[i + 1]) & 0xe0) == 0x80;
    if (!is_c1 && ((code >= 0x20 && code != 0x7f) || code == '\n' || code == '\t')) {
      out += text[i];
      continue;
    }
    const auto shown = is_c1 ? static_cast<unsigned char>(text[++i]) : code;
    out.append("\\x").append(1, digits[shown >> 4]).append(1, digits[shown & 15]);
  }
  return out;
}

}  // namespace terrazzo
