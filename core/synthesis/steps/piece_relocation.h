#pragma once

#include <cstdint>

#include "core/synthesis/steps/correction.h"

namespace terrazzo {

/// Lets whole pieces (connected pixels that continue one another in the exemplar) show another part of the exemplar
/// where that fits their neighbours better: what they show was decided at levels too coarse to see how they would meet.
/// Tried are the places that similar pixels along a piece's seams suggest, and some at random, dearer the more they are
/// in use. Pieces keep their shape, join no neighbour and show nothing that shows close by, so that they neither grow
/// nor repeat. Those that fit worst come first. Blocks are as for align_pieces(), and so is `level.fixed`; controls
/// have no say. The result does not depend on the number of threads. The field must hold the whole plane. Throws
/// Cancelled.
void relocate_pieces(Field& field, int block, const CorrectionLevel& level, const UsagePenalty& usage, uint64_t seed,
                     const Task& task);

}  // namespace terrazzo
