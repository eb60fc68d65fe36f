#pragma once

#include <vector>

#include "core/analysis/repeats/lag_correlation.h"

namespace terrazzo {

/// The nearest of the strong peaks: a lattice's shortest vectors are among them, however many points it has.
std::vector<Vector2d> near_peaks(const Correlation& r);

}  // namespace terrazzo
