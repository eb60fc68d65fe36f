#pragma once

#include "core/analysis/repeats/lag_correlation.h"
#include "core/exemplar/lattice.h"

namespace terrazzo {

struct Bands {
  Lattice lattice;      ///< of rank 1 (stripes aslant: 2), or 0 if no lines repeat
  double distinct = 0;  ///< how far lines that repeat stand out, of what differs from line to line at all
  double alike = 0;     ///< how much lines that repeat are alike, along their whole length; nearly all must be
};

/// Courses, or columns: after how many pixels whole lines come again.
Bands bands_of(const Correlation& r, bool courses);

/// The same of stripes that run aslant, in the direction in which lines differ most from one another: of rank 2, since
/// they come again along both axes, with as long a step along the stripes as there is across them.
Bands stripes_of(const Correlation& r);

}  // namespace terrazzo
