#pragma once

#include <cstdint>
#include <vector>

#include "core/analysis/space/planes.h"

namespace terrazzo {

/// An exemplar, or a part of it, scaled down for the lattice search.
struct ExemplarView {
  Rect seen;         ///< the area, in pixels of the finest level
  Planes planes;     ///< wraps if it shows all of an exemplar that does
  Planes counts;     ///< one channel: 1 where pixels are allowed; without values if all are
  double scale = 1;  ///< pixels of the finest level per pixel, 1 or more

  bool empty() const;  ///< too small to hold repeats
};

/// `allowed`: per pixel of the exemplar whether it may be sampled, row by row; empty: all may. Crops to the allowed
/// area.
ExemplarView view_of(const Planes& exemplar, const std::vector<uint8_t>& allowed, const Rect& part);

/// The view of each part, all at the scale that the largest needs, so that they can be compared.
std::vector<ExemplarView> views_at_one_scale(const Planes& exemplar, const std::vector<uint8_t>& allowed,
                                             const std::vector<Rect>& parts);

}  // namespace terrazzo
