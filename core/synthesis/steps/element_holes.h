#pragma once

#include <cstdint>
#include <vector>

#include "core/synthesis/state/plane_window.h"

namespace terrazzo {

/// Where something is missing from a surface.
struct Hole {
  int column = 0, row = 0;
  int64_t squared = 0;  ///< of its radius, in pixels
};

/// Every pixel of a plane that lies farther than `least` pixels from what is filled, those farthest from it first, then
/// row by row. Distances count up to `farthest`. If nothing is filled there is one hole, in the middle. `filled`: row
/// by row; Thread-safe.
std::vector<Hole> find_holes(const std::vector<uint8_t>& filled, const Plane& plane, double least, int farthest);

}  // namespace terrazzo
