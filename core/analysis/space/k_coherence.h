#pragma once

#include "core/base/task.h"
#include "core/exemplar/appearance.h"

namespace terrazzo {

/// Finds the k-coherent candidates of every pixel (Tong et al. 2002): `per_pixel` (1..8) positions with similar
/// neighbourhoods, on every level but the finest, unless that is the only one. Candidates keep a distance from the
/// pixel and from one another; with a lattice they have the pixel's phase. Coarse levels are searched exhaustively,
/// finer ones from their parents' candidates by propagation, as generalized PatchMatch (Barnes et al. 2010), but in
/// rounds that read the previous one, so that the result does not depend on the order of work. Throws Cancelled.
IndexPtr make_index(const AppearancePtr& appearance, int per_pixel, const Task& task);

}  // namespace terrazzo
