#pragma once

#include "runner/plan/plan.h"

namespace terrazzo {

/// Seconds that computing a stage may take on two cores: from the pixels that it makes, or reads if it is a sink, and
/// the quality that it is asked for. Rough; it tells what takes minutes from what takes seconds. 0 if it is not going
/// to be computed, or of how many pixels is not known.
double guessed_seconds(const Plan& plan, const Stage& stage);

}  // namespace terrazzo
