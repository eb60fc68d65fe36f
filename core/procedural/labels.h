#pragma once

#include "core/base/task.h"
#include "core/image/image.h"
#include "core/procedural/surface.h"

namespace terrazzo {

/// Labels the element of the surface at every pixel's centre. Elements are numbered in reading order, and number i is
/// stored as i / (count - 1). One channel, 16 bits, guidance. Each element is a 4-connected region, across the border
/// if `wraps`: disconnected parts, such as the tip of a narrow corner, are assigned to neighbours.
ImagePtr element_labels(const Surface& surface, Size size, bool wraps, const Task& task);

}  // namespace terrazzo
