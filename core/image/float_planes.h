#pragma once

#include <string>
#include <vector>

#include "core/base/geometry.h"
#include "core/image/image.h"

namespace terrazzo {

/// Pixels held in memory with any number of channels, interleaved: what metrics and autocorrelation work on.
struct Planes {
  Size size;
  int channels = 0;
  std::vector<float> values;  ///< size.area() * channels

  static Planes zeros(Size size, int channels) {
    return {size, channels, std::vector<float>(size_t(size.area()) * channels)};
  }
  const float* pixel(int x, int y) const { return &values[(size_t(y) * size.width + x) * channels]; }
  float* pixel(int x, int y) { return &values[(size_t(y) * size.width + x) * channels]; }
};

/// An image's first `channels` channels; if it has fewer, its first one repeated.
Planes to_planes(const Image& image, const Rect& region, int channels);

/// A Gaussian blur, the border mirrored (edge pixels repeat), cut off at four sigma.
Planes blurred(const Planes& image, double sigma);

/// Each level half the one before (blurred with sigma 0.9, every second pixel kept), finest first.
std::vector<Planes> gaussian_pyramid(Planes finest, int levels);

/// Linear interpolation when growing, an area-weighted mean when shrinking.
Planes resampled(const Planes& image, Size size);

/// Mean and standard deviation per channel, summed in a fixed order.
struct ChannelStatistics {
  std::vector<double> mean, deviation;
};
ChannelStatistics channel_statistics(const Planes& image);

}  // namespace terrazzo
