#pragma once

#include "core/base/hash.h"
#include "core/exemplar/appearance.h"

namespace terrazzo::test {

/// What an exemplar shows of which no two pixels are alike.
inline AppearanceVector noise(int x, int y) {
  AppearanceVector v{};
  for (int d = 0; d < appearance_dimensions; d++) v[d] = int16_t(below(uint32_t(random_bits(7, x, y, d)), 2000)) - 1000;
  return v;
}

}  // namespace terrazzo::test
