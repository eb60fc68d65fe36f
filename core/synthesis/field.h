#pragma once

#include <vector>

#include "core/uv_map.h"

namespace terrazzo {

/// One level of a synthesis under way: which exemplar pixel each output pixel shows.
struct Field {
  Size size;
  std::vector<ExemplarPixel> pixels;
  ExemplarPixel& at(int x, int y) { return pixels[size_t(y) * size.width + x]; }
  const ExemplarPixel& at(int x, int y) const { return pixels[size_t(y) * size.width + x]; }
};

/// Where (x, y) lies in `pixels` of a field of that size; around the other side where it tiles, -1 beyond a border
/// where it does not.
inline int64_t pixel_index(Size size, int x, int y, bool tile_x, bool tile_y) {
  if (x < 0 || x >= size.width) {
    if (!tile_x) return -1;
    x = wrap(x, size.width);
  }
  if (y < 0 || y >= size.height) {
    if (!tile_y) return -1;
    y = wrap(y, size.height);
  }
  return int64_t{y} * size.width + x;
}

}  // namespace terrazzo
