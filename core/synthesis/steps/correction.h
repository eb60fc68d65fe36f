#pragma once

#include "core/base/task.h"
#include "core/synthesis/state/correction_level.h"
#include "core/synthesis/state/field.h"
#include "core/synthesis/state/usage_penalty.h"
#include "core/synthesis/steps/correction_pass.h"

namespace terrazzo {

/// One correction pass (Lefebvre & Hoppe 2005, section 4.3): every pixel takes the best of its neighbours'
/// continuations, their k-coherent candidates and some random places. It runs as four sub-passes over interleaved
/// pixels, each of which reads what the one before has written: the result depends neither on the order of work nor on
/// which part of the plane the field holds. Throws Cancelled, and Error for more candidates than the kernel takes.
void correct(Field& field, const CorrectionLevel& level, const CorrectionPass& pass, UsagePenalty& usage,
             const Task& task);

}  // namespace terrazzo
