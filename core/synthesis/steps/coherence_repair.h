#pragma once

#include <cstdint>

#include "core/synthesis/steps/correction.h"

namespace terrazzo {

/// Covers incoherent windows, those unlike any of the exemplar's, by patches of the exemplar. Each of the `tries`
/// patches that fit a window's rim best is laid along a minimum cut, as repair_seams() does, and the one stays that
/// leaves the least incoherence around it; none does unless that falls. `level.fixed` pixels stay; control costs are
/// ignored. The result does not depend on the number of threads. The field must hold the whole plane. Throws Cancelled.
void repair_incoherent(Field& field, const CorrectionLevel& level, UsagePenalty& usage, int tries, uint64_t seed,
                       const Task& task);

}  // namespace terrazzo
