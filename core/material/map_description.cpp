#include "core/material/map_description.h"

#include <sstream>

namespace terrazzo {

std::optional<DescribedMap> described_map(std::string_view description) {
  constexpr std::string_view mark = "terrazzo: ";
  std::istringstream lines{std::string(description)};
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(mark)) continue;
    std::istringstream words(line.substr(mark.size()));
    std::string word;
    words >> word;
    const std::optional<Semantic> semantic = semantic_from(word);
    if (!semantic) continue;
    DescribedMap out{.semantic = *semantic};
    while (words >> word) {
      if (word == "green=up") out.normal_y = NormalY::up;
      if (word == "green=down") out.normal_y = NormalY::down;
      constexpr std::string_view space = "color_space=";
      if (word.starts_with(space)) out.color_space = word.substr(space.size());
    }
    return out;
  }
  return std::nullopt;
}

}  // namespace terrazzo
