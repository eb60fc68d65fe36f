#include "core/image/float_planes.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "core/base/portable_math.h"

namespace terrazzo {

namespace {

std::vector<float> gaussian_weights(double sigma) {
  const int radius = int(4 * sigma + 0.5);
  std::vector<double> weights;
  double sum = 0;
  for (int i = -radius; i <= radius; i++) {
    weights.push_back(portable::exp(-double(i) * i / (2 * sigma * sigma)));
    sum += weights.back();
  }
  std::vector<float> out;
  for (const double w : weights) out.push_back(float(w / sum));
  return out;
}

int mirrored(int v, int n) {
  const int m = wrap(v, 2 * n);
  return m < n ? m : 2 * n - 1 - m;
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

Planes blurred(const Planes& image, double sigma) {
  const std::vector<float> weights = gaussian_weights(sigma);
  const int radius = int(weights.size()) / 2, c = image.channels;
  const auto [width, height] = image.size;
  const size_t row_values = size_t(width) * c;
  Planes columns = Planes::zeros(image.size, c), out = Planes::zeros(image.size, c);
  tbb::parallel_for(0, height, [&](int y) {
    float* to = columns.pixel(0, y);
    for (int t = -radius; t <= radius; t++) {
      const float* from = image.pixel(0, mirrored(y + t, height));
      const float w = weights[t + radius];
      for (size_t i = 0; i < row_values; i++) to[i] += w * from[i];
    }
  });
  tbb::parallel_for(0, height, [&](int y) {
    std::vector<float> padded(row_values + 2 * size_t(radius) * c);
    for (int x = -radius; x < width + radius; x++)
      std::copy_n(columns.pixel(mirrored(x, width), y), c, &padded[size_t(x + radius) * c]);
    float* to = out.pixel(0, y);
    for (size_t t = 0; t < weights.size(); t++) {
      const float* from = &padded[t * c];
      const float w = weights[t];
      for (size_t i = 0; i < row_values; i++) to[i] += w * from[i];
    }
  });
  return out;
}

std::vector<Planes> gaussian_pyramid(Planes finest, int levels) {
  std::vector<Planes> out;
  out.push_back(std::move(finest));
  while (int(out.size()) < levels) {
    const Planes smooth = blurred(out.back(), 0.9);
    Planes half = Planes::zeros({(smooth.size.width + 1) / 2, (smooth.size.height + 1) / 2}, smooth.channels);
    for (int y = 0; y < half.size.height; y++)
      for (int x = 0; x < half.size.width; x++)
        std::copy_n(smooth.pixel(2 * x, 2 * y), smooth.channels, half.pixel(x, y));
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
      const float* from = image.pixel(0, tap.at);
      for (size_t i = 0; i < row.size(); i++) row[i] += tap.weight * from[i];
    }
    for (int x = 0; x < size.width; x++)
      for (const Tap& tap : across[x])
        for (int k = 0; k < c; k++) out.pixel(x, y)[k] += tap.weight * row[size_t(tap.at) * c + k];
  });
  return out;
}

ChannelStatistics channel_statistics(const Planes& image) {
  const int c = image.channels;
  const double n = double(image.size.area());
  ChannelStatistics s{std::vector<double>(c), std::vector<double>(c)};
  for (size_t i = 0; i < image.values.size(); i += c)
    for (int k = 0; k < c; k++) s.mean[k] += image.values[i + k];
  for (double& m : s.mean) m /= n;
  for (size_t i = 0; i < image.values.size(); i += c)
    for (int k = 0; k < c; k++) {
      const double d = image.values[i + k] - s.mean[k];
      s.deviation[k] += d * d;
    }
  for (double& d : s.deviation) d = std::sqrt(d / n);
  return s;
}

}  // namespace terrazzo
