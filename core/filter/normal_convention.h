#pragma once

#include <optional>

#include "core/image/image.h"

namespace terrazzo {

/// Evidence from pixels about the direction of a normal map's green channel.
struct ConventionEvidence {
  std::optional<NormalY> normal_y;  ///< nullopt if the evidence is not clear
  double along_x = 0;               ///< correlation of the red channel with the slope of the height map, -1..1
  double along_y = 0;               ///< correlation of the green channel, read as pointing up, with the slope
  bool height_inverted = false;     ///< the height map seems to be inverted
};

/// The transformation by which a normal map would fit its height map.
struct NormalMisfit {
  enum class Kind : uint8_t { none, channels_swapped, turned_90, turned_180, turned_270, mirrored_x, mirrored_y };
  Kind kind = Kind::none;
  double along_x = 0, along_y = 0;  ///< correlations of red and green with the matching slopes
};

/// If normals do not fit the slopes of a height map, finds a transformation with which they do: red and green swapped,
/// or one of the two images rotated (clockwise) or mirrored. Reports one only if both correlations exceed 0.5. Tries
/// quarter turns only for square maps.
NormalMisfit misfit_with_height(const Image& normal, const Image& height);

/// The mean of the blue channel; below 0.5 normals point into the surface. 1 if there is no blue channel.
double mean_blue(const Image& normal);

/// Compares the normals with the slopes of a height map (any size). Decides if both correlations exceed 0.1 in
/// magnitude, or if green's alone exceeds 0.5. Deterministic; uses at most 512x512 averaged points.
ConventionEvidence convention_from_height(const Image& normal, const Image& height);

/// Decides from the normals alone: the slopes of a surface have no curl, so with the right green convention d(slope
/// x)/dy equals d(slope y)/dx. `along_y` holds their correlation for the convention "up"; decides beyond 0.2.
ConventionEvidence convention_from_curl(const Image& normal);

}  // namespace terrazzo
