#pragma once

#include <vector>

#include "core/base/task.h"
#include "core/image/float_planes.h"

namespace terrazzo {

/// The offset from an output pixel to the exemplar pixel it shows.
struct Shift {
  int x = 0;
  int y = 0;
  bool operator==(const Shift&) const = default;
};

/// Regions copied as a whole: connected pixels of equal shift, where gaps of one pixel in a row or column are bridged.
struct CopiedRegions {
  double typical_side = 0;  ///< square root of the area, averaged over pixels; in pixels
  double largest_area = 0;  ///< in pixels
};
CopiedRegions copied_regions(Size size, const std::vector<Shift>& shifts);

/// The typical side of a copied region as a fraction of the exemplar's side, from each output patch's nearest exemplar
/// patch. Plain tiling gives 0.7 to 1. Throws Cancelled.
double verbatim_copies(const Planes& exemplar, const Planes& output, const Task& task);

}  // namespace terrazzo
