#pragma once

#include "core/synthesis/steps/correction.h"

namespace terrazzo {

/// How seams move.
struct SeamMoves {
  int reach = 8;  ///< by how many pixels of the field a piece may spread
  /// What it costs a pixel to go over to a piece, for each pixel between it and that piece, in units of appearance
  /// space. Seams go far only to a joint, and to either side alike, so that pieces do not grow by it.
  double stay = 0;
  /// A pixel of the field stands for `block` x `block` pixels of the level, which continue the exemplar pixel it names.
  int block = 1;
  /// If above 0, to be of a piece costs each of its pixels the more the larger the piece is, so that large pieces do
  /// not swallow small ones. This many pixels of the field are a fair size.
  double fair_piece = 0;
};

/// Moves the seams between pieces to where they show least. Edges hide them: on the two sides of a joint anything goes,
/// across the middle of a brick it does not. Each piece in turn, the largest first, spreads over its
/// neighbours' pixels as far as that lowers the mismatch summed along all seams. The best way to spread is a minimum
/// cut (expansion moves: Boykov, Veksler & Zabih 2001; for textures Kwatra et al. 2003, also for dearer seams where
/// there is no edge), so seams move where no single pixel would gain. `level.fixed` tells which pixels of the field
/// stay; controls have no say. Throws Cancelled.
void move_seams(Field& field, const CorrectionLevel& level, const SeamMoves& moves, const Task& task);

}  // namespace terrazzo
