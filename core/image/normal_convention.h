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

/// Compares the normals with the slopes of a height map (any size). Clear if both correlations are beyond 0.1, or
/// green's alone is beyond 0.5. Deterministic; looks at no more than 512x512 averaged points.
ConventionEvidence convention_from_height(const Image& normal, const Image& height);

/// Decides from the normals alone: slopes of a surface have no curl, so of the two readings of the green channel the
/// right one makes d(slope x)/dy agree with d(slope y)/dx. `along_y` holds the correlation of the two for the reading
/// "up"; clear beyond 0.2.
ConventionEvidence convention_from_curl(const Image& normal);

}  // namespace terrazzo
