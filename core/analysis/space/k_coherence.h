#pragma once

#include "core/base/task.h"
#include "core/exemplar/appearance.h"

namespace terrazzo {

/// Finds `per_pixel` (1..8) positions of similar surroundings for every pixel of every level but the finest (unless it
/// is the only one), where synthesis does without. Members of a set keep a distance from the pixel itself and from one
/// another, so that they offer real alternatives; of a regular exemplar they lie at the same place in the lattice's
/// cell. Coarse levels are searched exhaustively; finer ones start from their parent's sets and spread good finds to
/// neighbours, in the manner of generalized PatchMatch (Barnes et al. 2010) but in rounds that read the round before:
/// the result does not depend on the order of work.
IndexPtr make_index(const AppearancePtr& appearance, int per_pixel, const Task& task);

}  // namespace terrazzo
