#pragma once

#include <vector>

#include "core/exemplar/uv_map.h"

namespace terrazzo {

/// One level of a synthesis under way: which exemplar pixel each output pixel shows.
struct Field {
  Size size;
  std::vector<ExemplarPixel> pixels;
  ExemplarPixel& at(int x, int y) { return pixels[size_t(y) * size.width + x]; }
  const ExemplarPixel& at(int x, int y) const { return pixels[size_t(y) * size.width + x]; }
};

/// The index of (x, y) in `pixels` of a field of that size. Positions beyond a border wrap around if the field tiles
/// there; else -1.
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

/// Steps to the four neighbours of a pixel; side (s + 2) % 4 is opposite.
inline constexpr int sides[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};

/// The index of a pixel's neighbour on that side; -1 beyond a border.
inline int64_t pixel_beside(Size size, int pixel, int side, bool tile_x, bool tile_y) {
  return pixel_index(size, pixel % size.width + sides[side][0], pixel / size.width + sides[side][1], tile_x, tile_y);
}

}  // namespace terrazzo
