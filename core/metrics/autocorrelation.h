#pragma once

#include <vector>

#include "core/base/task.h"
#include "core/image/float_planes.h"

namespace terrazzo {

/// A channel's linear autocorrelation (Wiener-Khinchin), each lag divided by the number of pixel pairs it covers and by
/// the value at lag 0. The other half of the plane is its mirror image.
struct Correlogram {
  Size lags;  ///< lags 0..width-1 in x, -(height-1)..height-1 in y
  std::vector<double> values;
  double at(int dx, int dy) const { return values[size_t(dy + lags.height - 1) * lags.width + dx]; }
};

/// Of every channel, as it is (subtract the mean first). `lags`: how many, at most the image's size.
std::vector<Correlogram> correlograms(const Planes& image, Size lags, const Task& task);

/// Mean absolute difference of the two images' autocorrelation, meaned over channels, at lags up to a quarter of the
/// smaller image's shorter side. 0 = the same; shows whether long-range structure (courses, weaves) was kept.
double autocorrelation_difference(const Planes& exemplar, const Planes& output, const Task& task);

/// How much the output's highest autocorrelation peak at far lags (more than `near` pixels, where at least a fifth of
/// the image overlaps) exceeds the exemplar's; 0 if it does not. Shows visible repetition.
double repetition(const Planes& exemplar, const Planes& output, const Task& task);

}  // namespace terrazzo
