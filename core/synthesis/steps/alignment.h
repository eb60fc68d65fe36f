#pragma once

#include "core/synthesis/steps/correction.h"

namespace terrazzo {

/// Moves whole pieces (connected pixels that continue one another in the exemplar) by up to `reach` pixels to where
/// they fit their neighbours best. Upsampling leaves a piece's place uncertain by about a pixel, and pixel by pixel it
/// cannot be mended: each pixel is held where it is by the rest of its piece. Pieces move one after the other, the
/// largest first. A pixel of the field stands for a block of `block` x `block` pixels of the level, which continue the
/// exemplar pixel it names: pieces hold whole blocks when they have just been upsampled. `level.fixed` tells which
/// pixels of the field are fixed. Throws Cancelled.
void align_pieces(Field& field, int block, const CorrectionLevel& level, int reach, const Task& task);

}  // namespace terrazzo
