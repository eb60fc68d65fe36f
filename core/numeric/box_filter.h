#pragma once

#include <vector>

#include "core/base/geometry.h"

namespace terrazzo {

/// The mean around every pixel, weighted by a pyramid of `radius` pixels (a box of half that radius applied twice along
/// each axis). `pixels`: interleaved channels. Beyond a border lies the other side, or the border pixels go on. Summed
/// in a fixed order: the same bits on every machine. Parallel.
std::vector<float> box_filter(std::vector<float> pixels, Size size, int channels, int radius, bool wraps);

}  // namespace terrazzo
