#pragma once

#include <cstdint>

#include "core/synthesis/steps/correction.h"

namespace terrazzo {

/// Covers places where seams show most by what the exemplar has for their surroundings (patch fitting: Kwatra et al.,
/// Graphcut textures, 2003). Windows of 13x13 pixels whose seams show more than most are gone through, the
/// worst first. Of the exemplar's places that the window's rim, its similar pixels and chance suggest, the one that
/// fits the rim best is offered to the whole window, and a minimum cut takes as much of it as lowers the mismatch. So
/// bricks made of two halves become whole, which no correction of single pixels does. Nothing is offered that shows
/// near by already, or that is out of phase. `level.fixed` pixels stay; controls have no say. The result does not
/// depend on the number of threads. The field must hold the whole plane. Throws Cancelled.
void repair_seams(Field& field, const CorrectionLevel& level, UsagePenalty& usage, uint64_t seed, const Task& task);

}  // namespace terrazzo
