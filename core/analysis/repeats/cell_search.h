#pragma once

#include <vector>

#include "core/analysis/repeats/lag_correlation.h"
#include "core/exemplar/lattice.h"

namespace terrazzo {

struct Cell {
  Lattice lattice;      ///< of rank 2, as certain as what repeats is alike; of rank 0 if there is none
  double distinct = 0;  ///< how far the correlation on its points stands out of that around them, of how far it could
};

/// The lattice on whose points the correlation stands out most from that around them, or the densest that does not do
/// worse by more than chance: multiples of a cell do as well as the cell itself, parts of a cell (the grid of a
/// herringbone's joints) do worse. `further`: lattices to try besides those that peaks of the correlation span.
Cell best_cell(const Correlation& r, const std::vector<Lattice>& further);

/// The lattice, or the one of a few times as large a cell on whose points another correlation is clearly higher: the
/// joints of a chequered floor lie on a grid, but only every second tile has the same colour.
Lattice without_false_repeats(const Correlation& r, const Lattice& lattice);

}  // namespace terrazzo
