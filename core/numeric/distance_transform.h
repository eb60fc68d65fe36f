#pragma once

#include <cstdint>
#include <vector>

#include "core/base/geometry.h"

/// Distance transforms of masks. Own code since no library in use has one that is exact, wraps and names the nearest
/// pixel.
namespace terrazzo {

/// For every pixel the squared Euclidean distance to the nearest pixel that is set, exactly (Meijster, Roerdink &
/// Hesselink 2000). `wraps`: distances wrap around the borders. If no pixel is set, all are (width + height)^2.
std::vector<int64_t> squared_distances(const std::vector<uint8_t>& mask, Size size, bool wraps);

/// For every pixel the position y * width + x of a nearest pixel that is set, by the same distance. One must be set.
std::vector<uint32_t> nearest_set(const std::vector<uint8_t>& mask, Size size, bool wraps);

/// The signed distance to the mask's outline, negative where the mask is set: the distance to the nearest pixel of the
/// other kind minus one half. In pixels, clamped to [-limit, limit].
std::vector<float> signed_distances(const std::vector<uint8_t>& mask, Size size, bool wraps, float limit);
/// The same without wrapping, on the calling thread only: for operations that must not wait for others.
std::vector<float> signed_distances_here(const std::vector<uint8_t>& mask, Size size, float limit);

}  // namespace terrazzo
