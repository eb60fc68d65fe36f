#pragma once

#include "core/base/task.h"
#include "core/exemplar/features.h"

namespace terrazzo {

/// A smooth control map: how far each place of an exemplar has got between two extremes, such as clean and worn or dry
/// and wet (progressively variant textures; Zhang et al. 2003, Matusik et al. 2005). The weighted channels, blurred by
/// a Gaussian of `deviation` pixels, are projected on the direction in which they then vary most (their first principal
/// component; towards a lighter, or larger, first channel), and the values replaced by their rank, from 0 to 1: each
/// value is as frequent as any other. 0.5 everywhere if nothing varies. `inverted`: 1 becomes 0. The same bits on every
/// machine. Semantic guidance, one channel.
ImagePtr progression_of(const Features& features, double deviation, bool inverted, const Task& task);

}  // namespace terrazzo
