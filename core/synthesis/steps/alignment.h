#pragma once

#include "core/synthesis/steps/correction.h"

namespace terrazzo {

/// Moves whole pieces (connected pixels that continue one another in the exemplar) by up to `reach` pixels to where
/// they fit their neighbours best. Upsampling leaves a piece's offset uncertain by about a pixel, and correction cannot
/// repair that: each pixel is held in place by the rest of its piece. Pieces move one after the other, the largest
/// first. A pixel of the field stands for a block of `block` x `block` pixels of the level, which continue the exemplar
/// pixel it names, as just after upsampling. `level.fixed` refers to pixels of the field; their pieces stay. Throws
/// Cancelled.
void align_pieces(Field& field, int block, const CorrectionLevel& level, int reach, const Task& task);

}  // namespace terrazzo
