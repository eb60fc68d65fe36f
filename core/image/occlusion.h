#pragma once

#include "core/image/image.h"

namespace terrazzo {

struct OcclusionOptions {
  double height_scale = 16;  ///< how many pixels tall a height of 1 is
  int radius = 32;           ///< how far occluders are looked for, pixels; at least 1
  double strength = 1;       ///< factor on the darkening
  Outside outside = Outside::clamp;
};

/// The part of a cosine-weighted sky that a point of a height field sees, looking along 16 directions for the horizon
/// (horizon-based ambient occlusion; Bavoil and Sainz 2008, and for height fields Timonen and Westerholm 2010). In a
/// direction whose horizon has the slope t, 1 / (1 + t^2) of the sky is left. Slopes fade with distance to nothing at
/// the radius, so that no occluder appears suddenly. Writes one value in [0, 1] per pixel of `region`, which lies
/// inside the image, from heights up to the radius around it; cost grows with the radius. Thread-safe.
void occlusion_from_height(const PixelView& height, const Rect& region, const OcclusionOptions& options, float* out);

}  // namespace terrazzo
