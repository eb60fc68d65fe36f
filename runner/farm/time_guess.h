#pragma once

#include "runner/plan/plan.h"

namespace terrazzo {

/// A rough estimate of a stage's seconds on two cores, from the pixels that it computes (or reads, for sinks) and its
/// quality setting. Distinguishes minutes from seconds. 0 if the stage will not be computed, or if the number of pixels
/// is unknown.
double guessed_seconds(const Plan& plan, const Stage& stage);

}  // namespace terrazzo
