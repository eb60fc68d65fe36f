#pragma once

#include "core/base/task.h"
#include "core/image/float_planes.h"

namespace terrazzo {

/// How differently values stand beside one another (Haralick et al. 1973, over joint values of all channels): pixels
/// are sorted into 16 classes that are equally frequent in the exemplar; for offsets of 1, 2, 4 and 8 pixels in four
/// directions the tables of class pairs are compared by total variation. Mean over offsets: 0 = the same, 1 = nothing
/// in common.
double cooccurrence_distance(const Planes& exemplar, const Planes& output, const Task& task);

}  // namespace terrazzo
