#include "core/metrics/autocorrelation.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/numeric/fft.h"

namespace terrazzo {

namespace {

/// Not std::norm, which some libraries compute by hypot.
double squared(const std::complex<double>& z) {
  return z.real() * z.real() + z.imag() * z.imag();
}

int shorter_side(const Planes& a, const Planes& b) {
  return std::min({a.size.width, a.size.height, b.size.width, b.size.height});
}

Planes without_mean(Planes image) {
  const VectorXd mean = channel_moments(image).mean_vector();
  for (size_t i = 0; i < image.values.size(); i++) image.values[i] -= float(mean[int(i % image.channels)]);
  return image;
}

Correlogram normalized(const std::vector<std::complex<double>>& sums, bool imaginary, Size image, Size padded,
                       Size lags) {
  Correlogram out{lags, {}};
  const double count = double(padded.area());
  const auto mean_product = [&](int dx, int dy) {
    const std::complex<double>& v = sums[size_t(wrap(dy, padded.height)) * padded.width + dx];
    const double pairs = double(image.width - dx) * (image.height - std::abs(dy));
    return (imaginary ? v.imag() : v.real()) / count / pairs;
  };
  const double variance = mean_product(0, 0) + 1e-9;
  for (int dy = 1 - lags.height; dy < lags.height; dy++)
    for (int dx = 0; dx < lags.width; dx++) out.values.push_back(mean_product(dx, dy) / variance);
  return out;
}

using ComplexGrid = std::vector<std::complex<double>>;

Size padded_size(const Planes& image, Size lags) {
  return {padded_length(image.size.width + lags.width), padded_length(image.size.height + lags.height)};
}

/// The power spectra of channels c and c + 1 as real and imaginary parts: one complex transform serves two real
/// channels. The imaginary part is 0 if c is the last channel.
ComplexGrid power_spectra(const Planes& image, int c, Size padded) {
  const bool two = c + 1 < image.channels;
  ComplexGrid grid(size_t(padded.area()));
  for (int y = 0; y < image.size.height; y++)
    for (int x = 0; x < image.size.width; x++) {
      const float* v = image.at(x, y) + c;
      grid[size_t(y) * padded.width + x] = {v[0], two ? v[1] : 0.0};
    }
  transform_2d(grid, padded.width, padded.height, false, image.size.height, padded.width);
  ComplexGrid power(grid.size());
  for (int y = 0; y < padded.height; y++) {
    const std::complex<double>* row = &grid[size_t(y) * padded.width];
    const std::complex<double>* mirrored = &grid[size_t((padded.height - y) % padded.height) * padded.width];
    std::complex<double>* out = &power[size_t(y) * padded.width];
    for (int x = 0; x < padded.width; x++) {
      const std::complex<double> z = row[x], m = std::conj(mirrored[x == 0 ? 0 : padded.width - x]);
      out[x] = {squared(z + m) / 4, squared(z - m) / 4};
    }
  }
  return power;
}

/// The input of far_peak: details up to the size `near`, of all channels together.
Planes details(const Planes& image, int near, const Task& task) {
  const Planes smooth = blurred(image, 1, Beyond::mirrored, task);
  Planes mean = Planes::zeros(image.size, 1);
  for (size_t i = 0; i < mean.values.size(); i++) {
    for (int k = 0; k < image.channels; k++) mean.values[i] += smooth.values[i * image.channels + k];
    mean.values[i] /= float(image.channels);
  }
  const Planes coarse = blurred(mean, near, Beyond::mirrored, task);
  for (size_t i = 0; i < mean.values.size(); i++) mean.values[i] -= coarse.values[i];
  return mean;
}

double far_peak(const Planes& image, int near, const Task& task) {
  const Correlogram r = correlograms(details(image, near, task), image.size, task).front();
  double best = -1;
  for (int dy = 1 - r.lags.height; dy < r.lags.height; dy++)
    for (int dx = 0; dx < r.lags.width; dx++) {
      const double pairs = double(image.size.width - dx) * (image.size.height - std::abs(dy));
      const bool overlaps = pairs > 0.2 * double(image.size.area());
      if (int64_t{dx} * dx + int64_t{dy} * dy > int64_t{near} * near)
        best = std::max(best, overlaps ? r.at(dx, dy) : 0);
    }
  return best;
}

}  // namespace

std::vector<Correlogram> correlograms(const Planes& image, Size lags, const Task& task) {
  const Size padded = padded_size(image, lags);
  std::vector<Correlogram> out;
  for (int c = 0; c < image.channels; c += 2) {
    task.check();
    ComplexGrid power = power_spectra(image, c, padded);
    transform_2d(power, padded.width, padded.height, true, padded.height, lags.width);
    out.push_back(normalized(power, false, image.size, padded, lags));
    if (c + 1 < image.channels) out.push_back(normalized(power, true, image.size, padded, lags));
  }
  return out;
}

Correlogram pooled_correlogram(const Planes& image, Size lags, const Task& task) {
  const Size padded = padded_size(image, lags);
  ComplexGrid sum(size_t(padded.area()));
  for (int c = 0; c < image.channels; c += 2) {
    task.check();
    const ComplexGrid power = power_spectra(image, c, padded);
    for (size_t i = 0; i < sum.size(); i++) sum[i] += power[i].real() + power[i].imag();
  }
  transform_2d(sum, padded.width, padded.height, true, padded.height, lags.width);
  return normalized(sum, false, image.size, padded, lags);
}

double autocorrelation_difference(const Planes& exemplar, const Planes& output, const Task& task) {
  const int lag = std::max(1, shorter_side(exemplar, output) / 4);
  const auto a = correlograms(without_mean(exemplar), {lag, lag}, task);
  const auto b = correlograms(without_mean(output), {lag, lag}, task);
  double sum = 0;
  for (size_t i = 0; i < a.front().values.size(); i++) {
    double difference = 0;
    for (size_t c = 0; c < a.size(); c++) difference += a[c].values[i] - b[c].values[i];
    sum += std::abs(difference) / double(a.size());
  }
  return sum / double(a.front().values.size());
}

int correlation_length(const Planes& image, const Task& task) {
  constexpr double falls_to = 0.36787944117144233;  // 1/e
  const int side = std::min(image.size.width, image.size.height), most = std::max(1, side / 4);
  const Planes coarse = box_blurred(image, side / 8.0, task);
  Planes fine = image;
  for (size_t i = 0; i < fine.values.size(); i++) fine.values[i] -= coarse.values[i];
  std::vector<double> sums(size_t(most) + 1), counts(sums.size());
  for (const Correlogram& r : correlograms(without_mean(std::move(fine)), {most, most}, task))
    for (int dy = 1 - most; dy < most; dy++)
      for (int dx = 0; dx < most; dx++) {
        const double apart = std::sqrt(double(dx * dx + dy * dy));
        if (apart + 0.5 >= double(sums.size())) continue;
        sums[size_t(apart + 0.5)] += r.at(dx, dy);
        counts[size_t(apart + 0.5)]++;
      }
  for (int lag = 1; lag < most; lag++)
    if (sums[lag] / counts[lag] < falls_to * sums[1] / counts[1]) return lag;
  return most;
}

double repetition(const Planes& exemplar, const Planes& output, const Task& task) {
  const int near = std::max(1, shorter_side(exemplar, output) / 8);
  return std::max(0.0, far_peak(output, near, task) - far_peak(exemplar, near, task));
}

}  // namespace terrazzo
