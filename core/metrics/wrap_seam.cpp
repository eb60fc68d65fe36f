#include "core/metrics/wrap_seam.h"

#include <cmath>

namespace terrazzo {

namespace {

struct Sum {
  double total = 0;
  int64_t count = 0;
  void add(const float* a, const float* b, size_t n) {
    for (size_t i = 0; i < n; i++) total += std::abs(double(a[i]) - b[i]);
    count += int64_t(n);
  }
  /// A quarter of an 8-bit step keeps flat maps from a division by 0.
  double mean() const { return (count > 0 ? total / double(count) : 0) + 0.25 / 255; }
};

}  // namespace

WrapSeam wrap_seam(const Image& image) {
  const size_t c = size_t(image.channels()), row = size_t(image.width()) * c;
  Sum across, down, border_x, border_y;
  std::vector<float> first, previous;
  for_each_strip(image, [&](const Rect& strip, const float* pixels) {
    for (int y = 0; y < strip.height; y++, pixels += row) {
      across.add(pixels, pixels + c, row - c);
      border_x.add(pixels, pixels + row - c, c);
      if (previous.empty())
        first.assign(pixels, pixels + row);
      else
        down.add(previous.data(), pixels, row);
      previous.assign(pixels, pixels + row);
    }
  });
  border_y.add(first.data(), previous.data(), row);
  WrapSeam seam;
  if (image.width() > 1) seam.x = border_x.mean() / across.mean();
  if (image.height() > 1) seam.y = border_y.mean() / down.mean();
  return seam;
}

}  // namespace terrazzo
