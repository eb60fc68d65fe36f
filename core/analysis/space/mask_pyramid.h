#pragma once

#include <cstdint>
#include <vector>

#include "core/exemplar/features.h"

namespace terrazzo {

/// 1 where the features' mask allows sampling, per pixel, row by row; empty without a mask. Throws Error about "mask"
/// if it allows none.
std::vector<uint8_t> allowed_pixels(const Features& features);

/// Which pixels of a pyramid level (0 = finest) synthesis may use, given `allowed` at the finest level of size
/// `finest`: those whose comparison window sees only allowed pixels; if too few, all that are fully allowed; at coarse
/// levels, as a last resort, those with any allowed pixel below. At the finest level only allowed pixels are usable; at
/// least one always is. Empty if `allowed` is.
std::vector<uint8_t> usable_pixels(const std::vector<uint8_t>& allowed, Size finest, int level, bool wraps);

}  // namespace terrazzo
