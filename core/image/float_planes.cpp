#include "core/image/float_planes.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "core/numeric/box_filter.h"
#include "core/numeric/gaussian.h"
#include "core/numeric/weighted_row_sum.h"

namespace terrazzo {

namespace {

int mirrored(int v, int n) {
  const int m = wrap(v, 2 * n);
  return m < n ? m : 2 * n - 1 - m;
}

int row_beyond(const Planes& image, int y, Beyond beyond) {
  return beyond == Beyond::mirrored ? mirrored(y, image.size.height) : image.row(y);
}

int column_beyond(const Planes& image, int x, Beyond beyond) {
  return beyond == Beyond::mirrored ? mirrored(x, image.size.width) : image.column(x);
}

/// One output pixel along an axis: the input pixels that make it up.
struct Tap {
  int at;
  float weight;
};

std::vector<std::vector<Tap>> resampling_taps(int from, int to) {
  const double ratio = double(from) / to, reach = std::max(1.0, ratio);
  std::vector<std::vector<Tap>> taps(to);
  for (int i = 0; i < to; i++) {
    const double center = (i + 0.5) * ratio - 0.5;
    double sum = 0;
    std::vector<std::pair<int, double>> found;
    for (int j = int(std::floor(center - reach)); j <= int(std::ceil(center + reach)); j++) {
      // Shrinking: the overlap of the input pixel with the output pixel; growing: a tent.
      const double weight = ratio > 1 ? std::min(j + 0.5, center + ratio / 2) - std::max(j - 0.5, center - ratio / 2)
                                      : 1 - std::abs(j - center);
      if (weight <= 0) continue;
      found.emplace_back(std::clamp(j, 0, from - 1), weight);
      sum += weight;
    }
    for (const auto& [at, weight] : found) taps[i].push_back({at, float(weight / sum)});
  }
  return taps;
}

}  // namespace

Planes to_planes(const Image& image, const Rect& region, int channels) {
  const std::vector<float> pixels = image.read(region);
  Planes out = Planes::zeros({region.width, region.height}, channels);
  for (size_t i = 0; i < size_t(region.area()); i++)
    for (int k = 0; k < channels; k++)
      out.values[i * channels + k] = pixels[i * image.channels() + (channels <= image.channels() ? k : 0)];
  return out;
}

Planes filtered_down(const Planes& image, const std::vector<float>& kernel, Beyond beyond, const Task& task) {
  const int radius = int(kernel.size()) / 2, height = image.size.height;
  const size_t row_values = size_t(image.size.width) * image.channels;
  Planes out = Planes::zeros(image.size, image.channels, image.wraps);
  tbb::parallel_for(0, height, [&](int y) {
    task.check();
    if (y >= radius && y + radius < height) {
      weighted_row_sum(out.at(0, y), int(row_values), image.at(0, y - radius), row_values, kernel.data(), 1,
                       kernel.size());
      return;
    }
    for (int t = -radius; t <= radius; t++)
      weighted_row_sum(out.at(0, y), int(row_values), image.at(0, row_beyond(image, y + t, beyond)), row_values,
                       &kernel[size_t(t + radius)], 1, 1);
  });
  return out;
}

Planes filtered_across(const Planes& image, const std::vector<float>& kernel, Beyond beyond, const Task& task) {
  const int radius = int(kernel.size()) / 2, width = image.size.width, c = image.channels;
  const size_t row_values = size_t(width) * c;
  Planes out = Planes::zeros(image.size, c, image.wraps);
  tbb::parallel_for(0, image.size.height, [&](int y) {
    task.check();
    std::vector<float> padded(row_values + 2 * size_t(radius) * c);
    for (int x = -radius; x < width + radius; x++)
      std::copy_n(image.at(column_beyond(image, x, beyond), y), c, &padded[size_t(x + radius) * c]);
    weighted_row_sum(out.at(0, y), int(row_values), padded.data(), size_t(c), kernel.data(), 1, kernel.size());
  });
  return out;
}

Planes blurred(const Planes& image, double sigma, Beyond beyond, const Task& task) {
  if (!(sigma > 0)) return image;
  const std::vector<float> kernel = gaussian_kernel(sigma, int(4 * sigma + 0.5));
  return filtered_across(filtered_down(image, kernel, beyond, task), kernel, beyond, task);
}

Planes box_blurred(Planes image, double sigma, const Task& task) {
  constexpr int passes = 3;
  if (sigma > 0)
    box_filter(image.values, image.size, image.channels, Box::of_variance(sigma * sigma / passes), passes, image.wraps,
               task);
  return image;
}

std::vector<Planes> gaussian_pyramid(Planes finest, int levels, const Task& task) {
  std::vector<Planes> out;
  out.push_back(std::move(finest));
  while (int(out.size()) < levels) {
    const Planes& fine = out.back();
    const Planes smooth = blurred(fine, 0.9, around_or_mirrored(fine), task);
    const bool wraps = fine.wraps && fine.size.width % 2 == 0 && fine.size.height % 2 == 0;
    Planes half = Planes::zeros({(fine.size.width + 1) / 2, (fine.size.height + 1) / 2}, fine.channels, wraps);
    for (int y = 0; y < half.size.height; y++)
      for (int x = 0; x < half.size.width; x++) std::copy_n(smooth.at(2 * x, 2 * y), smooth.channels, half.at(x, y));
    out.push_back(std::move(half));
  }
  return out;
}

Planes resampled(const Planes& image, Size size) {
  if (size == image.size) return image;
  const auto across = resampling_taps(image.size.width, size.width);
  const auto down = resampling_taps(image.size.height, size.height);
  const int c = image.channels;
  Planes out = Planes::zeros(size, c);
  tbb::parallel_for(0, size.height, [&](int y) {
    std::vector<float> row(size_t(image.size.width) * c);
    for (const Tap& tap : down[y]) {
      const float* from = image.at(0, tap.at);
      for (size_t i = 0; i < row.size(); i++) row[i] += tap.weight * from[i];
    }
    for (int x = 0; x < size.width; x++)
      for (const Tap& tap : across[x])
        for (int k = 0; k < c; k++) out.at(x, y)[k] += tap.weight * row[size_t(tap.at) * c + k];
  });
  return out;
}

Moments<> channel_moments(const Planes& image) {
  Moments<> out(image.channels);
  for (size_t i = 0; i < image.values.size(); i += size_t(image.channels)) out.add(&image.values[i]);
  return out;
}

}  // namespace terrazzo
