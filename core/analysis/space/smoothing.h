#pragma once

#include "core/analysis/space/planes.h"

namespace terrazzo {

/// A Gaussian blur of any standard deviation (pixels) at the same cost: three passes of extended box filters of the
/// same variance (Gwosdek, Grewenig, Bruhn & Weickert, Theoretical foundations of Gaussian convolution by extended box
/// filtering, 2011). Beyond the border the planes wrap or continue, as they say. The same bits on every machine.
ExemplarPlanes box_smoothed(const ExemplarPlanes& planes, double deviation, const Task& task);

}  // namespace terrazzo
