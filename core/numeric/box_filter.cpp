#include "core/numeric/box_filter.h"

#include <algorithm>

#include <tbb/parallel_for.h>

namespace terrazzo {

namespace {

/// One line of samples that lie `stride` floats apart, replaced by the means of 2 * radius + 1 of them.
void box(float* line, int length, size_t stride, int radius, bool wraps, std::vector<float>& copy) {
  copy.resize(size_t(length));
  for (int i = 0; i < length; i++) copy[size_t(i)] = line[size_t(i) * stride];
  const auto at = [&](int i) { return double(copy[size_t(wraps ? wrap(i, length) : std::clamp(i, 0, length - 1))]); };
  double sum = 0;
  for (int i = -radius; i <= radius; i++) sum += at(i);
  for (int i = 0; i < length; i++) {
    line[size_t(i) * stride] = float(sum / (2 * radius + 1));
    sum += at(i + radius + 1) - at(i - radius);
  }
}

}  // namespace

std::vector<float> box_filter(std::vector<float> pixels, Size size, int channels, int radius, bool wraps) {
  const int half = std::max(1, (radius + 1) / 2);
  const size_t row = size_t(size.width) * channels;
  const auto filter = [&](int lines, auto line, int length, size_t stride) {
    tbb::parallel_for(0, lines, [&](int i) {
      std::vector<float> copy;
      for (int c = 0; c < channels; c++)
        for (int pass = 0; pass < 2; pass++) box(&pixels[line(i) + size_t(c)], length, stride, half, wraps, copy);
    });
  };
  filter(
      size.height, [row](int y) { return size_t(y) * row; }, size.width, size_t(channels));
  filter(
      size.width, [channels](int x) { return size_t(x) * size_t(channels); }, size.height, row);
  return pixels;
}

}  // namespace terrazzo
