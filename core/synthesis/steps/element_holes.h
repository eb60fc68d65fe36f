#pragma once

#include <cstdint>
#include <vector>

#include "core/base/geometry.h"

namespace terrazzo {

/// Where something is missing from a surface.
struct Hole {
  int column = 0, row = 0;
  int64_t squared = 0;  ///< of its radius, in pixels
};

/// Every pixel that lies farther than `least` pixels from what is filled, those farthest from it first, then row by
/// row. Distances count up to `farthest`. If nothing is filled there is one hole, in the middle. `filled`: row by row;
/// `closed_x`, `closed_y`: it wraps around. Thread-safe.
std::vector<Hole> find_holes(const std::vector<uint8_t>& filled, Size size, bool closed_x, bool closed_y, double least,
                             int farthest);

}  // namespace terrazzo
