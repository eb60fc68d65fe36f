#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/image/image.h"
#include "core/numeric/eigen.h"

/// Tangent-space normals: x to the right, y up the image, z out of the surface. Stored encoded, n * 0.5 + 0.5, with y
/// reversed where an image's normal_y is down. Thread-safe.
namespace terrazzo {

/// Sums from x to z: Eigen's norm() uses another order for three components.
float length(const Vector3f& v);

/// The unit vector of the same direction; (0, 0, 1) for the zero vector.
Vector3f normalized(const Vector3f& v);

/// Decodes a normal to a vector with y up; does not normalise it.
Vector3f decode_normal(const float* pixel, NormalY normal_y);
void encode_normal(const Vector3f& normal, NormalY normal_y, float* pixel);

/// Normalises encoded normals in place: the first three of each pixel's `channels` values.
void renormalize(float* pixels, int channels, int64_t count);

/// Flips the green channel of encoded normals in place, from up to down or back. Values from 8- and 16-bit files stay
/// on steps of that depth, so flipping twice gives the same bits.
void flip_green(float* pixels, int channels, int64_t count, Depth depth);

/// The normal map in the `wanted` green convention, computed when pulled. Returns other images, and maps already in
/// that convention, unchanged.
ImagePtr with_normal_y(const ImagePtr& image, NormalY wanted);

/// Adds `detail` to `base` by rotating it into the base's tangent frame: reoriented normal mapping (Barre-Brisebois and
/// Hill, Blending in Detail, 2012). A flat detail returns the base, a flat base the detail.
Vector3f reoriented(const Vector3f& base, const Vector3f& detail);

/// Slope estimators on a 3x3 neighbourhood: smoothing across the derivative by 1 2 1 (Sobel), by 3 10 3 (Scharr 2000,
/// the most isotropic), or not at all.
enum class SlopeFilter : uint8_t { sobel, scharr, central };
std::optional<SlopeFilter> slope_filter_from(std::string_view name);

/// How many pixels around a region its normals depend on.
inline constexpr int slope_reach = 1;

/// Encoded normals of a height field, one for each pixel of `region`, which lies inside the image. `height_scale`: the
/// height of value 1 in pixels.
void normals_from_height(const PixelView& height, const Rect& region, double height_scale, SlopeFilter filter,
                         Outside outside, NormalY normal_y, float* out);

}  // namespace terrazzo
