#pragma once

#include <cstdint>
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

/// An exemplar position in 32 bits, in the order of rows. Packed steps, which may be negative, can be added to it.
constexpr uint32_t packed(int x, int y) {
  return (uint32_t(y) << 16) + uint32_t(x);
}
constexpr uint32_t packed(const ExemplarPixel& p) {
  return packed(p.x, p.y);
}
constexpr ExemplarPixel unpacked(uint32_t position) {
  return {uint16_t(position & 0xffff), uint16_t(position >> 16)};
}

}  // namespace terrazzo
