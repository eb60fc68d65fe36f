#pragma once

#include "core/base/task.h"
#include "core/synthesis/state/correction_level.h"
#include "core/synthesis/state/field.h"

namespace terrazzo {

/// How seams move.
struct SeamMoves {
  int reach;  ///< by how many pixels of the field a piece may spread
  /// The cost of a pixel that changes over to a piece, per pixel of distance from that piece, in appearance units. Then
  /// seams go far only to a joint, and to either side alike, so that pieces do not grow by it.
  double distance_penalty = 0;
  /// If above 0, pixels pay in proportion to the area of their piece, so that large pieces do not swallow small ones:
  /// seams.fair_unary_cost at this area, in pixels of the field.
  double target_area = 0;
};

/// Moves the seams between pieces to where they show least. Edges hide them: along a joint any two bricks may meet,
/// within a brick they may not. Each piece in turn, the largest first, spreads over its neighbours' pixels as far as
/// that lowers the mismatch summed along all seams. The best way to spread is a minimum cut (expansion moves: Boykov,
/// Veksler & Zabih 2001; for textures Kwatra et al. 2003, who also make seams along edges cheaper), so that seams move
/// where no single pixel would gain. `level.fixed` refers to pixels of the field, which stay. Under controls no pixel
/// changes to what costs more. Throws Cancelled.
void move_seams(Field& field, const CorrectionLevel& level, const SeamMoves& moves, const Task& task);

}  // namespace terrazzo
