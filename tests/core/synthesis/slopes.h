#pragma once

#include "core/analysis/space/padded_level.h"
#include "tests/core/synthesis/noise.h"

namespace terrazzo::test {

/// An exemplar that changes little from one pixel to the next and shows every window once only.
inline PaddedLevel slopes(Size size, const std::vector<uint8_t>& usable = {}, bool wraps = false) {
  AppearanceLevel level;
  level.size = size;
  level.usable = usable;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      AppearanceVector v = noise(x, y);
      for (int d = 2; d < appearance_dimensions; d++) v[d] = int16_t(v[d] / 100);
      v[0] = int16_t(20 * x - 640);
      v[1] = int16_t(20 * y - 640);
      level.vectors.push_back(v);
    }
  return {level, wraps};
}

}  // namespace terrazzo::test
