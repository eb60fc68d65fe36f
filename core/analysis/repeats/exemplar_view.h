#pragma once

#include <cstdint>
#include <vector>

#include "core/analysis/space/planes.h"

namespace terrazzo {

/// What can be seen of an exemplar, or of a part of it, at a size at which repeats are looked for.
struct ExemplarView {
  Rect seen;         ///< what it shows, in pixels of the finest level
  Planes planes;     ///< wraps if that is all of an exemplar that does
  Planes counts;     ///< one channel: 1 where pixels are allowed; without values if all are
  double scale = 1;  ///< pixels of the finest level to one of these

  bool empty() const;  ///< too little to hold repeats
};

/// `allowed`: per pixel of the exemplar whether it may be sampled; empty: all may. What is around that is left out.
ExemplarView view_of(const Planes& exemplar, const std::vector<uint8_t>& allowed, const Rect& part);

/// The view of each part, all at the scale that the largest needs, so that they can be compared.
std::vector<ExemplarView> views_at_one_scale(const Planes& exemplar, const std::vector<uint8_t>& allowed,
                                             const std::vector<Rect>& parts);

}  // namespace terrazzo
