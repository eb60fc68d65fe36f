#pragma once

#include "core/analysis/space/planes.h"
#include "core/exemplar/lattice.h"

namespace terrazzo {

/// The lattice of an exemplar that tiles and shows straight lines from border to border, such as the joints of one
/// large tile, though nothing in it comes twice: one cell, or several if its lines repeat. `outlines`: as by
/// outlines(). Rank 1 if lines run along one axis only. Rank 0 if there are none, or if they say nothing against
/// `found`, a lattice found otherwise.
Lattice lattice_of_lines(const Planes& outlines, const Lattice& found);

/// Whether straight lines run from border to border both ways, as joints between tiles do.
bool lines_cross(const Planes& outlines);

}  // namespace terrazzo
