#pragma once

#include <cstdint>

#include "core/image/image.h"

/// The visible sky above each point of a height field, from its horizon in 16 directions (horizon-based ambient
/// occlusion; Bavoil and Sainz 2008, and for height fields Timonen and Westerholm 2010). The sky is the half space
/// above the image's plane, so horizons are never below it. Slopes to the horizon fade to zero at the radius, so that
/// no occluder appears abruptly. `region` lies inside the image; its pixels depend on heights up to the radius around
/// it. Time grows with the radius. Thread-safe.
namespace terrazzo {

struct HorizonOptions {
  double height_scale = 16;  ///< the height of value 1 in pixels
  int radius = 32;           ///< search radius for occluders in pixels; at least 1
  Outside outside = Outside::clamp;
};

/// The visible fraction of a cosine-weighted sky: 1 / (1 + t^2) in a direction whose horizon has slope t. `strength`:
/// factor on the darkening. One value in [0, 1] per pixel.
void occlusion_from_height(const PixelView& height, const Rect& region, const HorizonOptions& options, double strength,
                           float* out);

/// The weights of sky directions: by the cosine to the vertical, as for diffuse light on a flat surface, or uniform.
enum class SkyWeight : uint8_t { cosine, uniform };

/// Bent normals: the mean direction of the visible sky (Landis, Production-Ready Global Illumination, 2002), as encoded
/// normals of 3 values per pixel. Straight up where no sky is visible.
void bent_normals_from_height(const PixelView& height, const Rect& region, const HorizonOptions& options,
                              SkyWeight weight, NormalY normal_y, float* out);

}  // namespace terrazzo
