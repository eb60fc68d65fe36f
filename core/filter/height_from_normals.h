#pragma once

#include <optional>
#include <vector>

#include "core/base/task.h"
#include "core/image/image.h"
#include "core/image/normal.h"

namespace terrazzo {

struct IntegrationOptions {
  /// How the normals' slopes were measured, as by normals_from_height; nullopt: at the pixels' centres.
  std::optional<SlopeFilter> filter = SlopeFilter::scharr;
  Outside outside = Outside::clamp;  ///< wrap: the surface tiles; clamp: it ends at the border
  double flatten = 0;                ///< pixels; shapes much wider than this are levelled out; 0: none
};

/// The surface whose slopes come nearest to those of a normal map, in pixels, with mean 0, row by row.
///
/// Each pixel is to rise to its right and lower neighbours as the slopes around say. No surface may do so exactly: the
/// one with the least sum of squared errors satisfies a Poisson equation (Horn and Brooks 1986; Simchony, Chellappa and
/// Shao 1990; Frankot and Chellappa 1988 solve it by Fourier transforms), which multigrid cycles solve. `flatten` adds
/// a screening term: waves of w radians per pixel keep k / (k + 1 / flatten^2) of their height, with
/// k = 4 sin^2(w / 2). Rises are interpolated from four slopes along, and sharpened across by as much as the filter has
/// smoothed, so that waves that normals_from_height has turned into normals come back within 0.05 % from 24 pixels
/// of wavelength, 0.5 % from 12, and near borders that clamp within 0.3 %. Slopes are limited to what 8 bits can hold,
/// 256.
///
/// The map has 3 channels or more. Same bits on any number of threads; takes 20 bytes per pixel. Throws Cancelled.
std::vector<float> heights_from_normals(const Image& normal, const IntegrationOptions& options, const Task& task);

}  // namespace terrazzo
