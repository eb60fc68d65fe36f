#pragma once

#include "core/image/image.h"

/// The mean curvature of a surface, from its unit normals n: half of their divergence, (dn_x/dx + dn_y/dy) / 2, which
/// is exact on slopes as well (do Carmo, Differential Geometry of Curves and Surfaces, 1976). In 1 / pixels, positive
/// where the surface is convex: 1 / R on a sphere of radius R, half as much on a cylinder. Thread-safe.
namespace terrazzo {

/// How many pixels around a region its leanings from heights, and its curvature from leanings, depend on.
inline constexpr int curvature_reach = 1;

/// The leaning of a surface: n_x and n_y of its normals, y down the image, two values per pixel of `region`, which lies
/// inside the image. `height_scale`: the height of value 1 in pixels. At a clamped border, slopes are one-sided.
void leanings_from_height(const PixelView& height, const Rect& region, double height_scale, Outside outside,
                          float* out);
/// The same from `count` encoded normals of `channels` values, 3 or more.
void leanings_from_normals(const float* normals, int channels, NormalY normal_y, int64_t count, float* out);

/// One value per pixel of `region`.
void curvature_from_leanings(const PixelView& leanings, const Rect& region, Outside outside, float* out);

}  // namespace terrazzo
