#pragma once

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

}  // namespace terrazzo
