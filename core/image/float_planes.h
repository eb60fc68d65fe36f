#pragma once

#include <algorithm>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/task.h"
#include "core/image/image.h"
#include "core/numeric/moments.h"

namespace terrazzo {

/// Pixels held in memory with any number of channels, interleaved: what analysis and metrics work on.
struct Planes {
  Size size;
  int channels = 0;
  bool wraps = false;         ///< the image tiles: what lies outside is the other side; else the border continues
  std::vector<float> values;  ///< size.area() * channels

  static Planes zeros(Size size, int channels, bool wraps = false) {
    return {size, channels, wraps, std::vector<float>(size_t(size.area()) * channels)};
  }
  const float* at(int x, int y) const { return values.data() + (size_t(y) * size.width + x) * channels; }
  float* at(int x, int y) { return values.data() + (size_t(y) * size.width + x) * channels; }
  /// The column or row that stands for one outside.
  int column(int x) const { return wraps ? wrap(x, size.width) : std::clamp(x, 0, size.width - 1); }
  int row(int y) const { return wraps ? wrap(y, size.height) : std::clamp(y, 0, size.height - 1); }
};

/// An image's first `channels` channels; if it has fewer, its first one repeated.
Planes to_planes(const Image& image, const Rect& region, int channels);

/// What lies beyond the border of an image that is filtered: what Planes::wraps says, or its mirror image (edge pixels
/// repeat).
enum class Beyond : uint8_t { as_it_wraps, mirrored };

/// A Gaussian blur, cut off at four sigma; of sigma 0 the image itself. Its time grows with the area times sigma.
/// Throws Cancelled.
Planes blurred(const Planes& image, double sigma, Beyond beyond, const Task& task);

/// A Gaussian blur of any sigma at the same cost, nearly: three box filters. Throws Cancelled.
Planes box_blurred(Planes image, double sigma, const Task& task);

/// Each level half the one before (blurred with sigma 0.9, every second pixel kept), finest first. Throws Cancelled.
std::vector<Planes> gaussian_pyramid(Planes finest, int levels, const Task& task);

/// Linear interpolation when growing, an area-weighted mean when shrinking.
Planes resampled(const Planes& image, Size size);

/// The mean and the covariance of the channels.
Moments<> channel_moments(const Planes& image);

}  // namespace terrazzo
