#pragma once

#include "core/base/task.h"
#include "core/exemplar/features.h"

namespace terrazzo {

/// A smooth control map of how far each place of an exemplar is between two extremes, such as clean and worn
/// (progressively variant textures; Zhang et al. 2003, Matusik et al. 2005): the weighted channels, blurred by a
/// Gaussian of `deviation` pixels, projected on their first principal component (towards a lighter, or larger, first
/// channel), and equalised to 0..1. 0.5 everywhere if nothing varies. `inverted`: 1 becomes 0. One channel, semantic
/// guidance. The same bits on every machine. Throws Cancelled.
ImagePtr progression_of(const Features& features, double deviation, bool inverted, const Task& task);

}  // namespace terrazzo
