#pragma once

#include <cstdint>
#include <vector>

#include "core/exemplar/features.h"

namespace terrazzo {

/// Where the features' mask lets the exemplar be sampled, one entry per pixel; empty if there is no mask. Throws Error
/// about "mask" if that is nowhere.
std::vector<uint8_t> allowed_pixels(const Features& features);

/// Which pixels of a pyramid level synthesis may take, given `allowed` at the finest level (size `finest`), and 0 = the
/// finest `level`: those whose comparison window sees allowed pixels only. Where that leaves too little, those that
/// are allowed as a whole; and at coarse levels, as a last resort, those with any allowed pixel below them. A finest
/// pixel that is not allowed is never usable, and there is always one that is. Empty if `allowed` is.
std::vector<uint8_t> usable_pixels(const std::vector<uint8_t>& allowed, Size finest, int level, bool wraps);

}  // namespace terrazzo
