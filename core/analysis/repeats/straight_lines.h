#pragma once

#include "core/analysis/space/planes.h"
#include "core/exemplar/lattice.h"

namespace terrazzo {

/// The lattice of a tileable exemplar with straight lines from border to border, such as the joints of a single tile:
/// one cell, or several if lines repeat. `outlines`: see outlines(). Rank 1 if lines run along one axis only; rank 0 if
/// there are none, or they agree with `found`, a lattice found otherwise.
Lattice lattice_of_lines(const Planes& outlines, const Lattice& found);

/// Whether straight lines run from border to border in both directions, as joints between tiles.
bool lines_cross(const Planes& outlines);

}  // namespace terrazzo
