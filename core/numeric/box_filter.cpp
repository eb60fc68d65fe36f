#include "core/numeric/box_filter.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

namespace terrazzo {

namespace {

/// One pass over a line by a running sum; `at` maps any position into the line.
template <typename At>
void filter(const std::vector<double>& in, const Box& box, const At& at, std::vector<double>& out) {
  const int n = int(in.size());
  double sum = 0;
  for (int i = -box.reach; i <= box.reach; i++) sum += in[at(i)];
  for (int x = 0; x < n; x++) {
    const double after = in[at(x + box.reach + 1)];
    out[x] = (sum + box.end * (in[at(x - box.reach - 1)] + after)) / box.sum();
    sum += after - in[at(x - box.reach)];
  }
}

/// `count` values, `stride` apart, filtered in place.
void filter_line(float* values, int count, size_t stride, const Box& box, int passes, bool wraps) {
  std::vector<double> line(count), next(count);
  for (int i = 0; i < count; i++) line[i] = values[i * stride];
  for (int p = 0; p < passes; p++) {
    if (wraps)
      filter(
          line, box, [count](int i) { return wrap(i, count); }, next);
    else
      filter(
          line, box, [count](int i) { return std::clamp(i, 0, count - 1); }, next);
    line.swap(next);
  }
  for (int i = 0; i < count; i++) values[i * stride] = float(line[i]);
}

}  // namespace

Box Box::of_variance(double variance) {
  Box out;
  out.reach = int(std::floor(0.5 * std::sqrt(12 * variance + 1) - 0.5));
  const double next = out.reach + 1.0;
  out.end = (2 * out.reach + 1) * (out.reach * next - 3 * variance) / (6 * (variance - next * next));
  return out;
}

void box_filter(std::vector<float>& pixels, Size size, int channels, const Box& box, int passes, bool wraps,
                const Task& task) {
  const size_t row = size_t(size.width) * channels;
  tbb::parallel_for(0, size.height, [&](int y) {
    task.check();
    for (int c = 0; c < channels; c++)
      filter_line(&pixels[y * row + size_t(c)], size.width, size_t(channels), box, passes, wraps);
  });
  tbb::parallel_for(0, size.width, [&](int x) {
    task.check();
    for (int c = 0; c < channels; c++)
      filter_line(&pixels[size_t(x) * channels + size_t(c)], size.height, row, box, passes, wraps);
  });
}

std::vector<float> local_mean(std::vector<float> pixels, Size size, int channels, int radius, bool wraps) {
  const Box half{std::max(1, (radius + 1) / 2), 0};
  box_filter(pixels, size, channels, half, 2, wraps, {});
  return pixels;
}

}  // namespace terrazzo
