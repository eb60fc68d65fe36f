#pragma once

#include "core/base/task.h"
#include "core/image/float_planes.h"

namespace terrazzo {

/// Distance of co-occurrence matrices (Haralick et al. 1973, over joint values of all channels): pixels are quantised
/// to 16 classes of equal frequency in the exemplar; matrices for offsets of 1, 2, 4 and 8 pixels in four directions
/// are compared by total variation. Mean over offsets: 0 = equal, 1 = nothing in common. Throws Cancelled.
double cooccurrence_distance(const Planes& exemplar, const Planes& output, const Task& task);

}  // namespace terrazzo
