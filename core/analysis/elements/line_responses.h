#pragma once

#include <vector>

#include "core/base/task.h"
#include "core/image/float_planes.h"

namespace terrazzo {

/// How much each place of an image looks like a line, as joints do: for every channel the difference of a centre and
/// its surroundings, negative where the channel has a valley, then one channel more with the strength of edges in all
/// channels. Lines are about as wide as two pixels.
Planes line_responses(const Planes& image, const Task& task);

/// The image along its first principal components, at most `most` of them, at unit total variance.
Planes leading_planes(const Planes& image, int most, const Task& task);

}  // namespace terrazzo
