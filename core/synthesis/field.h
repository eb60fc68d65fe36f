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

}  // namespace terrazzo
