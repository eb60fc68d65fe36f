#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/image/image.h"
#include "core/numeric/eigen.h"

/// Tangent-space normals: x to the right, y up the image, z out of the surface. Stored encoded, n * 0.5 + 0.5, with y
/// reversed where an image's normal_y is down. Thread-safe.
namespace terrazzo {

/// Summed from x to z, which is not the order in which Eigen's norm() takes three.
float length(const Vector3f& v);

/// The unit vector of the same direction; (0, 0, 1) for a vector without one.
Vector3f normalized(const Vector3f& v);

/// An encoded normal as a vector, y up, not normalised.
Vector3f decode_normal(const float* pixel, NormalY normal_y);
void encode_normal(const Vector3f& normal, NormalY normal_y, float* pixel);

/// Makes encoded normals unit length in place: the first three of each pixel's `channels` values.
void renormalize(float* pixels, int channels, int64_t count);

/// Reverses the green channel of encoded normals in place: from up to down, or from down to up. What comes from 8- and
/// 16-bit files gets the value of another step of that file, so that doing it twice gives the same bits.
void flip_green(float* pixels, int channels, int64_t count, Depth depth);

/// The normal map with green pointing that way, computed when pulled; anything else, and a map that has it so, as it
/// is.
ImagePtr with_normal_y(const ImagePtr& image, NormalY wanted);

/// `detail` laid over `base` by rotating it into the base's tangent frame: reoriented normal mapping (Barre-Brisebois
/// and Hill, Blending in Detail, 2012). A flat detail leaves the base, a flat base gives the detail.
Vector3f reoriented(const Vector3f& base, const Vector3f& detail);

/// How slopes are estimated from a 3x3 neighbourhood: smoothing across by 1 2 1 (Sobel), by 3 10 3 (Scharr 2000, the
/// most even over directions), or not at all.
enum class SlopeFilter : uint8_t { sobel, scharr, central };
std::optional<SlopeFilter> slope_filter_from(std::string_view name);

/// How many pixels around a region count for its normals.
inline constexpr int slope_reach = 1;

/// Normals of a height field, encoded, one for each pixel of `region`, which lies inside the image. `height_scale`: how
/// many pixels tall a height of 1 is.
void normals_from_height(const PixelView& height, const Rect& region, double height_scale, SlopeFilter filter,
                         Outside outside, NormalY normal_y, float* out);

}  // namespace terrazzo
