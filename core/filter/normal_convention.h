#pragma once

#include <optional>

#include "core/image/image.h"

namespace terrazzo {

/// What a normal map's pixels say about which way its green channel points.
struct ConventionEvidence {
  std::optional<NormalY> normal_y;  ///< nullopt if the evidence is not clear
  double along_x = 0;               ///< correlation of the red channel with the slope of the height map, -1..1
  double along_y = 0;               ///< correlation of the green channel, read as pointing up, with the slope
  bool height_inverted = false;     ///< the height map seems to be dark where the surface is high
};

/// How a normal map that does not fit its height would fit.
struct NormalMisfit {
  enum class Kind : uint8_t { none, channels_swapped, turned_90, turned_180, turned_270, mirrored_x, mirrored_y };
  Kind kind = Kind::none;
  double along_x = 0, along_y = 0;  ///< correlations of red and green with the slopes that they follow then
};

/// Looks for the way in which normals fit the slopes of a height map, where they do not as they are: red following the
/// slope along y and green that along x, or one of the two pictures turned (clockwise) or mirrored. Found only if both
/// correlations are beyond 0.5. Quarter turns are looked for in square maps.
NormalMisfit misfit_with_height(const Image& normal, const Image& height);

/// The mean of the blue channel; below 0.5 normals point into the surface. 1 if there is none.
double mean_blue(const Image& normal);

/// Compares the normals with the slopes of a height map (any size). Clear if both correlations are beyond 0.1, or
/// green's alone is beyond 0.5. Deterministic; looks at no more than 512x512 averaged points.
ConventionEvidence convention_from_height(const Image& normal, const Image& height);

/// Decides from the normals alone: slopes of a surface have no curl, so of the two readings of the green channel the
/// right one makes d(slope x)/dy agree with d(slope y)/dx. `along_y` holds the correlation of the two for the reading
/// "up"; clear beyond 0.2.
ConventionEvidence convention_from_curl(const Image& normal);

}  // namespace terrazzo
