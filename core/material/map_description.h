#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/image/image.h"

/// What an image file says of itself in its description, as `export` writes it there.
namespace terrazzo {

/// "terrazzo: normal green=up color_space=raw".
struct DescribedMap {
  Semantic semantic = Semantic::data;
  std::optional<NormalY> normal_y{};
  std::string color_space{};  ///< empty if it says none
};

/// Nullopt if none of the description's lines begins with "terrazzo: " and a map's name. What is not known is skipped.
std::optional<DescribedMap> described_map(std::string_view description);

}  // namespace terrazzo
