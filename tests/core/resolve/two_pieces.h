#pragma once

#include "core/exemplar/uv_map.h"

namespace terrazzo::test {

/// A uv map whose columns from `seam` on show a piece that lies `jump` pixels further right in the exemplar.
inline UvMapPtr two_pieces(Size size, int seam, int jump, UvWraps wraps = {}, Size exemplar = {64, 48}) {
  std::vector<ExemplarPixel> pixels;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++)
      pixels.push_back({uint16_t((x < seam ? x : x + jump) % exemplar.width), uint16_t(y % exemplar.height)});
  return UvMap::make(size, exemplar, std::move(pixels), wraps);
}

}  // namespace terrazzo::test
