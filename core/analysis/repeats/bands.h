#pragma once

#include "core/analysis/repeats/lag_correlation.h"
#include "core/exemplar/lattice.h"

namespace terrazzo {

/// Courses or columns that repeat.
struct Bands {
  Lattice lattice;      ///< of rank 1 (diagonal stripes: 2), or 0 if no lines repeat
  double distinct = 0;  ///< contrast of repeating lines, relative to all differences between lines
  double alike = 0;     ///< correlation of repeating lines along their whole length
};

/// Finds the period of courses, or of columns. Thread-safe.
Bands bands_of(const Correlation& r, bool courses);

/// Whether the exemplar shows so many that they come again by no chance.
bool come_often(const Lattice& bands, Size exemplar);
/// How many of them an exemplar is high, or wide.
double count_bands(const Lattice& bands, Size exemplar);

/// The same as bands_of() for diagonal stripes, in the direction in which lines differ most. Rank 2, as they repeat
/// along both axes; the step along the stripes is as long as the one across.
Bands stripes_of(const Correlation& r);

/// The same of stripes that come once around an exemplar that tiles and have edges (`joints`: the correlation of
/// outlines). Their certainty is how far lines half a period apart are opposites.
Bands single_stripes_of(const Correlation& r, const Correlation& joints);

/// The bands, or twice their period if every second one is turned or mirrored. `r`: the correlation of orientations.
Lattice with_turned_bands(const Correlation& r, const Lattice& bands);

}  // namespace terrazzo
