#pragma once

#include <vector>

#include "core/base/task.h"
#include "core/image/float_planes.h"

namespace terrazzo {

/// A channel's linear autocorrelation (Wiener-Khinchin), normalised by the number of pixel pairs at each lag and by the
/// value at lag 0. Half of the plane; the other half is symmetric.
struct Correlogram {
  Size lags;  ///< lags 0..width-1 in x, -(height-1)..height-1 in y
  std::vector<double> values;
  double at(int dx, int dy) const { return values[size_t(dy + lags.height - 1) * lags.width + dx]; }
};

/// Per channel; subtract the mean first. `lags`: at most the image's size. Throws Cancelled.
std::vector<Correlogram> correlograms(const Planes& image, Size lags, const Task& task);

/// The variance-weighted mean over all channels; subtract the means first. Throws Cancelled.
Correlogram pooled_correlogram(const Planes& image, Size lags, const Task& task);

/// Mean absolute difference of the images' autocorrelations, averaged over channels, at lags up to a quarter of the
/// smaller image's shorter side. 0 = equal; measures whether long-range structure (courses, weaves) was kept.
double autocorrelation_difference(const Planes& exemplar, const Planes& output, const Task& task);

/// How much the output's highest autocorrelation peak at far lags (beyond an eighth of the smaller image's shorter
/// side, with at least a fifth of the image overlapping) exceeds the exemplar's; 0 if it does not. Measures visible
/// repetition.
double repetition(const Planes& exemplar, const Planes& output, const Task& task);

/// The lag in pixels at which the radial mean of the channels' autocorrelations falls below 1/e of its value at one
/// pixel. Ignores variations longer than an eighth of the shorter side. At most a quarter of that side. For stones of
/// different colours, about a quarter of their width.
int correlation_length(const Planes& image, const Task& task);

}  // namespace terrazzo
