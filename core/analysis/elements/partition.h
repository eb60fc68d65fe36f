#pragma once

#include <cstdint>
#include <vector>

#include "core/base/geometry.h"
#include "core/numeric/watershed.h"

namespace terrazzo {

/// A picture parted along the lines of a relief, and how well that relief knows its lines.
struct Partition {
  Regions regions;
  double contrast = 0;  ///< height of the lines kept, beyond that of those given up, in deviations of both
  double weak = 0;      ///< share of the kept lines' pixels that stand out little
  double stray = 0;     ///< share of the pixels inside regions that stand out like the lines around them
  double thin = 0;      ///< share of the picture in regions that are no wider than lines
  double compact = 0;   ///< 1 for squares, less for ragged or elongated regions; mean over the picture
  double spanning = 0;  ///< share of the picture in regions that reach from border to border, or around it
  double largest = 0;   ///< share of the picture in the largest region
  double number = 1;    ///< of regions, weighted by area (inverse Simpson index): one large region among crumbs is one

  /// How well the lines part the picture, to choose among partitions of one picture.
  double quality() const;
  /// How sure it is that the regions are elements: 3.6 and less in lava, bark, dunes, grass and soil, 3.9 and more in
  /// masonry. Bubbles and bark have other lines inside their regions, and few regions stand out by chance.
  double confidence() const;
};

/// Parts a picture where `relief` is high. `line`: the width of a line, in pixels.
Partition partitioned(const std::vector<uint8_t>& relief, Size size, bool wraps, double line);

}  // namespace terrazzo
