#pragma once

#include <cstdint>
#include <vector>

#include "core/base/geometry.h"

namespace terrazzo {

/// A segmentation of an image.
struct Regions {
  std::vector<uint32_t> at;  ///< the region of each pixel, row by row: 0 to count - 1
  int count = 0;
};

/// The catchment basins of a relief, flooded from each of its minima (Meyer, Topographic distance and watershed lines,
/// 1994): every pixel belongs to the basin from which it is reached first. `wraps`: the relief wraps around the
/// borders. Deterministic. Thread-safe.
Regions catchment_basins(const std::vector<uint8_t>& relief, Size size, bool wraps);

/// The same, flooded from given regions: `seeds` holds a region, or `no_region`, per pixel.
inline constexpr uint32_t no_region = ~0U;
Regions flooded(const std::vector<uint8_t>& relief, Size size, bool wraps, std::vector<uint32_t> seeds);

/// 1 for pixels on both sides of borders between regions, given by arbitrary labels per pixel.
template <typename Name>
std::vector<uint8_t> border_pixels(const std::vector<Name>& regions, Size size, bool wraps) {
  std::vector<uint8_t> border(regions.size(), 0);
  const auto compare = [&](size_t p, size_t q) {
    if (regions[p] != regions[q]) border[p] = border[q] = 1;
  };
  const auto w = size_t(size.width), h = size_t(size.height);
  for (size_t y = 0; y < h; y++)
    for (size_t x = 0; x < w; x++) {
      if (x + 1 < w || wraps) compare(y * w + x, y * w + (x + 1) % w);
      if (y + 1 < h || wraps) compare(y * w + x, (y + 1) % h * w + x);
    }
  return border;
}

/// The common border of two regions.
struct RegionBorder {
  uint32_t a = 0, b = 0;  ///< a < b
  int64_t length = 0;     ///< pairs of pixels, one on either side
  int64_t height = 0;     ///< sum over them of the relief's higher pixel
  double mean() const { return double(height) / double(length); }
};
/// In a fixed order.
std::vector<RegionBorder> region_borders(const Regions& regions, const std::vector<uint8_t>& relief, Size size,
                                         bool wraps);

/// Neighbouring regions are joined if the mean of their border is below a threshold.
struct JoiningRule {
  double least = 0;           ///< threshold if at least one region is small
  double least_of_large = 0;  ///< threshold if both have at least `large` pixels; at most `least`
  int64_t large = 0;
  int64_t smallest = 0;  ///< smaller regions are always joined, across their lowest border
};

/// Joins regions across their borders, lowest first. Borders that merge get the mean over all their pixels.
Regions joined(const Regions& regions, const std::vector<RegionBorder>& borders, const JoiningRule& rule);

}  // namespace terrazzo
