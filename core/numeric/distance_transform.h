#pragma once

#include <cstdint>
#include <vector>

#include "core/base/geometry.h"

namespace terrazzo {

/// For every pixel the squared Euclidean distance to the nearest pixel that is set, exactly (Meijster, Roerdink &
/// Hesselink 2000). `wraps`: distances go around the borders. If no pixel is set, all are (width + height)^2.
std::vector<int64_t> squared_distances(const std::vector<uint8_t>& mask, Size size, bool wraps);

/// For every pixel the position y * width + x of a nearest pixel that is set, by the same distance. One must be set.
std::vector<uint32_t> nearest_set(const std::vector<uint8_t>& mask, Size size, bool wraps);

/// Distance to the nearest pixel of the other kind, less a half, negative where the mask is set: 0 lies on the outline.
/// In pixels, at most `limit` in size.
std::vector<float> signed_distances(const std::vector<uint8_t>& mask, Size size, bool wraps, float limit);
/// The same without wrapping, on the calling thread only: for operations that must not wait for others.
std::vector<float> signed_distances_here(const std::vector<uint8_t>& mask, Size size, float limit);

}  // namespace terrazzo
