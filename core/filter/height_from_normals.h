#pragma once

#include <optional>
#include <vector>

#include "core/base/task.h"
#include "core/image/image.h"
#include "core/image/normal.h"

namespace terrazzo {

struct IntegrationOptions {
  /// The filter of normals_from_height by which the normals were made; nullopt: slopes at pixel centres.
  std::optional<SlopeFilter> filter = SlopeFilter::scharr;
  Outside outside = Outside::clamp;  ///< wrap: the surface tiles; clamp: it ends at the border
  double flatten = 0;                ///< in pixels: wider shapes are flattened; 0: off
};

/// Integrates a normal map by least squares. Returns heights in pixels, with mean 0, row by row.
///
/// The slopes give the target differences between neighbouring pixels. The surface with the least squared error solves
/// a Poisson equation (Horn and Brooks 1986; Simchony, Chellappa and Shao 1990; Frankot and Chellappa 1988 use Fourier
/// transforms), here by multigrid. `flatten` adds a screening term: waves of w radians per pixel keep k / (k + 1 /
/// flatten^2) of their height, with k = 4 sin^2(w / 2). Differences are interpolated from four slopes along the axis
/// and sharpened across it to undo the filter's smoothing. So waves converted by normals_from_height are restored
/// within 0.05 % from wavelengths of 24 pixels, 0.5 % from 12, and 0.3 % near clamped borders. Slopes are limited to
/// 256, the most that 8 bits can represent.
///
/// The map has 3 channels or more. The result does not depend on the number of threads. Takes 20 bytes per pixel.
/// Throws Cancelled.
std::vector<float> heights_from_normals(const Image& normal, const IntegrationOptions& options, const Task& task);

}  // namespace terrazzo
