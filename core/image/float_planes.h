#pragma once

#include <algorithm>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/task.h"
#include "core/image/image.h"
#include "core/numeric/moments.h"

namespace terrazzo {

/// Pixels in memory with any number of interleaved channels, for analysis and metrics.
struct Planes {
  Size size;
  int channels = 0;
  bool wraps = false;         ///< the image tiles: coordinates outside wrap around; else they are clamped to the border
  std::vector<float> values;  ///< size.area() * channels

  static Planes zeros(Size size, int channels, bool wraps = false) {
    return {size, channels, wraps, std::vector<float>(size_t(size.area()) * channels)};
  }
  const float* at(int x, int y) const { return values.data() + (size_t(y) * size.width + x) * channels; }
  float* at(int x, int y) { return values.data() + (size_t(y) * size.width + x) * channels; }
  /// The column or row inside the image for any coordinate: wrapped or clamped.
  int column(int x) const { return wraps ? wrap(x, size.width) : std::clamp(x, 0, size.width - 1); }
  int row(int y) const { return wraps ? wrap(y, size.height) : std::clamp(y, 0, size.height - 1); }
};

/// A region of the image's first `channels` channels. If it has fewer, its first channel is repeated.
Planes to_planes(const Image& image, const Rect& region, int channels);

/// How a filter extends an image beyond its border: as Planes::wraps says, or mirrored (edge pixels repeat).
enum class Beyond : uint8_t { as_it_wraps, mirrored };
/// Around the border of an image that wraps, else mirrored.
inline Beyond around_or_mirrored(const Planes& image) {
  return image.wraps ? Beyond::as_it_wraps : Beyond::mirrored;
}

/// The sum of 2 r + 1 rows, from r rows above to r rows below, each times its factor in the kernel; the other with
/// columns. Throws Cancelled.
Planes filtered_down(const Planes& image, const std::vector<float>& kernel, Beyond beyond, const Task& task);
Planes filtered_across(const Planes& image, const std::vector<float>& kernel, Beyond beyond, const Task& task);

/// A Gaussian blur, truncated at four sigma (in pixels); sigma 0 returns the image itself. Takes time proportional to
/// the area times sigma. Throws Cancelled.
Planes blurred(const Planes& image, double sigma, Beyond beyond, const Task& task);

/// An approximate Gaussian blur by three box filters, in time nearly independent of sigma. Throws Cancelled.
Planes box_blurred(Planes image, double sigma, const Task& task);

/// A pyramid, finest level first. Each level is half the size of the previous one (blurred with sigma 0.9, every second
/// pixel kept), and wraps if that one does and its sides are even. Throws Cancelled.
std::vector<Planes> gaussian_pyramid(Planes finest, int levels, const Task& task);

/// Resizes: linear interpolation when growing, an area-weighted mean when shrinking.
Planes resampled(const Planes& image, Size size);

/// The mean and the covariance of the channels.
Moments<> channel_moments(const Planes& image);

}  // namespace terrazzo
