#pragma once

#include <cstdint>

#include "core/synthesis/steps/correction.h"

namespace terrazzo {

/// Lets whole pieces (connected pixels that continue one another in the exemplar) show another part of the exemplar
/// where that fits their neighbours better: what they show was decided at levels too coarse to see their seams.
/// Candidates come from the k-coherent candidates along a piece's seams and from chance; over-used parts cost more.
/// Pieces keep their shape, do not merge with a neighbour and show nothing that shows near by, so that they neither
/// grow nor repeat. Those that fit worst come first. Blocks are as for align_pieces(), and so is `level.fixed`; control
/// costs are ignored. The result does not depend on the number of threads. The field must hold the whole plane. Throws
/// Cancelled.
void relocate_pieces(Field& field, int block, const CorrectionLevel& level, const UsagePenalty& usage, uint64_t seed,
                     const Task& task);

}  // namespace terrazzo
