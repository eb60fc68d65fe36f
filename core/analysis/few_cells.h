#pragma once

#include "core/analysis/lag_correlation.h"
#include "core/analysis/planes.h"
#include "core/lattice.h"

namespace terrazzo {

/// The lattice of an exemplar that tiles and holds four to twelve cells, too few to see many of them in a row. The
/// exemplar's sides are whole numbers of such a lattice's steps, so all that are possible can be tried. Rank 0 if none
/// stands out. (Two or three cells are left alone: exemplars that were made to tile often hold parts of themselves
/// twice.)
Lattice lattice_of_few_cells(const Correlation& r, Size exemplar);

/// The lattice of an exemplar that tiles and shows straight lines from border to border, such as the joints of one
/// large tile, though nothing in it comes twice: one cell, or several if its lines repeat. `outlines`: as by
/// outlines(). Rank 1 if lines run along one axis only. Rank 0 if there are none, or if they say nothing against
/// `found`, a lattice found otherwise.
Lattice lattice_of_lines(const ExemplarPlanes& outlines, const Lattice& found);

}  // namespace terrazzo
