#pragma once

#include "core/synthesis/correction.h"

namespace terrazzo {

/// Moves the seams between pieces to where they show least: each piece in turn, the largest first, spreads over its
/// neighbours' pixels, up to `reach` away, as far as that lowers the mismatch summed along all seams. The best way to
/// spread is a minimum cut (expansion moves: Boykov, Veksler & Zabih 2001; for textures Kwatra et al. 2003), so seams
/// move where no single pixel would gain. `level.fixed` pixels stay; controls have no say. Throws Cancelled.
void move_seams(Field& field, const CorrectionLevel& level, int reach, const Task& task);

}  // namespace terrazzo
