#pragma once

#include <cstdint>

#include "core/synthesis/steps/correction.h"

namespace terrazzo {

/// Covers places that are unlike any of the exemplar's, as repair_seams() covers those whose seams show, but asks what
/// comes of it: of several of the exemplar's places that fit around a window that one is taken, cut along a minimum
/// cut, which leaves the fewest windows unlike all of the exemplar's, and none if that does not lower their number.
/// `tries`: how many are. `level.fixed` pixels stay; controls have no say. The result does not depend on the number of
/// threads. The field must hold the whole plane. Throws Cancelled.
void repair_incoherent(Field& field, const CorrectionLevel& level, UsagePenalty& usage, int tries, uint64_t seed,
                       const Task& task);

}  // namespace terrazzo
