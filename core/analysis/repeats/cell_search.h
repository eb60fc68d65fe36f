#pragma once

#include <vector>

#include "core/analysis/repeats/lag_correlation.h"
#include "core/exemplar/lattice.h"

namespace terrazzo {

/// A candidate for the cell of a lattice.
struct Cell {
  Lattice lattice;      ///< of rank 2, its certainty the correlation of repeats; rank 0 if there is none
  double distinct = 0;  ///< contrast of the correlation at its points against their surroundings, 0..1
};

/// The lattice whose points have the highest contrast in the correlation; of those that differ only by chance, the
/// densest: multiples of a cell score as well as the cell, parts of it (the joint grid of a herringbone) worse.
/// `further`: lattices to try besides those spanned by correlation peaks.
Cell best_cell(const Correlation& r, const std::vector<Lattice>& further);

/// The lattice, or one of a few times its cell if the correlation is clearly higher there: the joints of a chequered
/// floor form a grid, but only every second tile has the same colour. `least_gap`: what the other points must lack of the
/// correlation, 0..1.
Lattice without_false_repeats(const Correlation& r, const Lattice& lattice, double least_gap = 0);

}  // namespace terrazzo
