#pragma once

#include <cstdint>

#include "core/image/image.h"

/// What a point of a height field sees of the sky, looking along 16 directions for the horizon (horizon-based ambient
/// occlusion; Bavoil and Sainz 2008, and for height fields Timonen and Westerholm 2010). The sky is the half space
/// above the image's plane, so horizons are never below it. Slopes up to the horizon fade with distance to nothing at
/// the radius, so that no occluder appears suddenly. Pixels of `region`, which lies inside the image, are made from
/// heights up to the radius around it; cost grows with the radius. Thread-safe.
namespace terrazzo {

struct HorizonOptions {
  double height_scale = 16;  ///< how many pixels tall a height of 1 is
  int radius = 32;           ///< how far occluders are looked for, pixels; at least 1
  Outside outside = Outside::clamp;
};

/// The part of a cosine-weighted sky that is seen: in a direction whose horizon has the slope t, 1 / (1 + t^2) of it is
/// left. `strength`: factor on the darkening. One value in [0, 1] per pixel.
void occlusion_from_height(const PixelView& height, const Rect& region, const HorizonOptions& options, double strength,
                           float* out);

/// How the directions of a sky count: by their cosine to the vertical, as light that falls on a flat surface does, or
/// all alike.
enum class SkyWeight : uint8_t { cosine, uniform };

/// Bent normals: the mean direction of the sky that is seen (Landis, Production-Ready Global Illumination, 2002), as
/// encoded normals of 3 values per pixel. Straight up where no sky is left.
void bent_normals_from_height(const PixelView& height, const Rect& region, const HorizonOptions& options,
                              SkyWeight weight, NormalY normal_y, float* out);

}  // namespace terrazzo
