#pragma once

#include <cstdint>

#include "core/base/task.h"
#include "core/synthesis/state/correction_level.h"
#include "core/synthesis/state/field.h"
#include "core/synthesis/state/usage_penalty.h"

namespace terrazzo {

/// Covers the most visible seams by patches of the exemplar that fit around them (patch fitting: Kwatra et al.,
/// Graphcut textures, 2003). Windows of 13x13 pixels whose seams mismatch more than the average are repaired, the worst
/// first. Of the patches that the window's rim, its k-coherent candidates and chance propose, the one that fits the rim
/// best is offered to the whole window, and a minimum cut takes as much of it as lowers the mismatch. So bricks made of
/// two halves become whole, which no correction of single pixels achieves. Patches that show near by already or are out
/// of phase are not offered. `level.fixed` pixels stay; control costs are ignored. The result does not depend on the
/// number of threads. The field must hold the whole plane. Throws Cancelled.
void repair_seams(Field& field, const CorrectionLevel& level, UsagePenalty& usage, uint64_t seed, const Task& task);

}  // namespace terrazzo
