#pragma once

#include "core/base/task.h"
#include "core/image/image.h"
#include "core/procedural/surface.h"

namespace terrazzo {

/// Which element of the surface lies at the middle of every pixel: elements are numbered in the order in which reading
/// left to right, top to bottom comes upon them, and number i is written as i / (count - 1). One channel, 16 bits,
/// guidance. Each element is one region whose pixels share sides, around the border if `wraps`: what pixels cut off of
/// it, such as the tip of a narrow corner, goes to its neighbours.
ImagePtr element_labels(const Surface& surface, Size size, bool wraps, const Task& task);

}  // namespace terrazzo
