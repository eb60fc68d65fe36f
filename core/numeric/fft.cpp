#include "core/numeric/fft.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <tbb/parallel_for.h>

namespace terrazzo {

namespace {

/// exp(-2 pi i k / length), k < length / 2: the primitive roots of all power-of-two orders by halving the angle; every
/// other one is a product of these.
std::vector<std::complex<double>> roots_of_one(int length) {
  std::vector<std::complex<double>> roots(size_t(std::max(1, length / 2)));
  roots[0] = 1;
  double cosine = -1, sine = 0;  // of pi, the angle of order 2
  for (int step = length / 2; step > 1; step /= 2) {
    const double half_cosine = std::sqrt((1 + cosine) / 2);
    const double half_sine = half_cosine == 0 ? 1 : sine / (2 * half_cosine);
    cosine = half_cosine;
    sine = half_sine;
    roots[size_t(step) / 2] = {cosine, -sine};
  }
  for (int k = 1; k < length / 2; k++) {
    const int lowest = k & -k;
    if (k == lowest) continue;
    const std::complex<double> a = roots[size_t(k - lowest)], b = roots[size_t(lowest)];
    roots[size_t(k)] = {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
  }
  return roots;
}

}  // namespace

int padded_length(int n) {
  int length = 1;
  while (length < n) length *= 2;
  return length;
}

Fft::Fft(int length) : length_(length), reversed_(length) {
  if (length < 1 || padded_length(length) != length) throw std::logic_error("the length must be a power of two");
  const std::vector<std::complex<double>> roots = roots_of_one(length);
  for (int half = 1; half < length; half *= 2)
    for (int k = 0; k < half; k++) twiddles_.push_back(roots[size_t(k) * size_t(length / (2 * half))]);
  for (int i = 1; i < length; i++) reversed_[i] = reversed_[i / 2] / 2 + (i % 2) * (length / 2);
}

void Fft::transform(std::complex<double>* values, bool inverse) const {
  for (int i = 0; i < length_; i++)
    if (i < reversed_[i]) std::swap(values[i], values[reversed_[i]]);
  const double sign = inverse ? -1 : 1;
  const std::complex<double>* twiddles = twiddles_.data();
  for (int half = 1; half < length_; twiddles += half, half *= 2)
    for (int first = 0; first < length_; first += 2 * half) {
      std::complex<double>*low = values + first, *high = low + half;
      for (int k = 0; k < half; k++) {
        const double c = twiddles[k].real(), s = sign * twiddles[k].imag();
        const std::complex<double> a = low[k], b = high[k];
        const std::complex<double> turned{b.real() * c - b.imag() * s, b.real() * s + b.imag() * c};
        low[k] = a + turned;
        high[k] = a - turned;
      }
    }
}

void transform_2d(std::vector<std::complex<double>>& grid, int width, int height, bool inverse) {
  transform_2d(grid, width, height, inverse, height, width);
}

void transform_2d(std::vector<std::complex<double>>& grid, int width, int height, bool inverse, int filled_rows,
                  int wanted_columns) {
  const Fft rows(width), columns(height);
  tbb::parallel_for(0, filled_rows, [&](int y) { rows.transform(&grid[size_t(y) * width], inverse); });
  constexpr int band = 8;  // columns moved together: whole cache lines
  tbb::parallel_for(0, (wanted_columns + band - 1) / band, [&](int piece) {
    const int x0 = piece * band, count = std::min(band, wanted_columns - x0);
    std::vector<std::complex<double>> column(size_t(height) * count);
    for (int y = 0; y < height; y++)
      for (int i = 0; i < count; i++) column[size_t(i) * height + y] = grid[size_t(y) * width + x0 + i];
    for (int i = 0; i < count; i++) columns.transform(&column[size_t(i) * height], inverse);
    for (int y = 0; y < height; y++)
      for (int i = 0; i < count; i++) grid[size_t(y) * width + x0 + i] = column[size_t(i) * height + y];
  });
}

}  // namespace terrazzo
