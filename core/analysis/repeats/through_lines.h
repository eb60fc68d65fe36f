#pragma once

#include "core/image/float_planes.h"

namespace terrazzo {

/// How far the strongest straight line from border to border stands out, level (`rows`) or upright: a thin joint, the
/// edge of a stripe, a frame. The change across a line is that between the means of lines beside each other, along each
/// eighth of them; what counts is the least of the eighths, in the direction of their mean, as a part of how much lines
/// change there in the mean. 1 and more: a line; grain, clouds and strata have less. 0 of fewer than eight pixels.
double strongest_line(const Planes& planes, bool rows);

}  // namespace terrazzo
