#include "core/numeric/fft.h"

#include <cmath>
#include <stdexcept>

#include <tbb/parallel_for.h>

namespace terrazzo {

int padded_length(int n) {
  int length = 1;
  while (length < n) length *= 2;
  return length;
}

Fft::Fft(int length) : length_(length), twiddles_(std::max(1, length / 2)), reversed_(length) {
  if (length < 1 || padded_length(length) != length) throw std::logic_error("the length must be a power of two");
  // The primitive roots of all power-of-two orders by halving the angle; every other factor is a product of these.
  twiddles_[0] = 1;
  double cosine = -1, sine = 0;  // of pi, the angle of order 2
  for (int step = length / 2; step > 1; step /= 2) {
    const double half_cosine = std::sqrt((1 + cosine) / 2);
    const double half_sine = half_cosine == 0 ? 1 : sine / (2 * half_cosine);
    cosine = half_cosine;
    sine = half_sine;
    twiddles_[step / 2] = {cosine, -sine};
  }
  for (int k = 1; k < length / 2; k++) {
    const int lowest = k & -k;
    if (k != lowest) {
      const std::complex<double> a = twiddles_[k - lowest], b = twiddles_[lowest];
      twiddles_[k] = {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
    }
  }
  for (int i = 1; i < length; i++) reversed_[i] = reversed_[i / 2] / 2 + (i % 2) * (length / 2);
}

void Fft::transform(std::complex<double>* values, bool inverse) const {
  for (int i = 0; i < length_; i++)
    if (i < reversed_[i]) std::swap(values[i], values[reversed_[i]]);
  for (int half = 1; half < length_; half *= 2) {
    const int stride = length_ / (2 * half);
    for (int first = 0; first < length_; first += 2 * half)
      for (int k = 0; k < half; k++) {
        const double c = twiddles_[size_t(k) * stride].real();
        const double s = inverse ? -twiddles_[size_t(k) * stride].imag() : twiddles_[size_t(k) * stride].imag();
        const std::complex<double> a = values[first + k], b = values[first + k + half];
        const std::complex<double> turned{b.real() * c - b.imag() * s, b.real() * s + b.imag() * c};
        values[first + k] = a + turned;
        values[first + k + half] = a - turned;
      }
  }
}

void transform_2d(std::vector<std::complex<double>>& grid, int width, int height, bool inverse) {
  const Fft rows(width), columns(height);
  tbb::parallel_for(0, height, [&](int y) { rows.transform(&grid[size_t(y) * width], inverse); });
  constexpr int band = 8;  // columns moved together: whole cache lines
  tbb::parallel_for(0, (width + band - 1) / band, [&](int piece) {
    const int x0 = piece * band, count = std::min(band, width - x0);
    std::vector<std::complex<double>> column(size_t(height) * count);
    for (int y = 0; y < height; y++)
      for (int i = 0; i < count; i++) column[size_t(i) * height + y] = grid[size_t(y) * width + x0 + i];
    for (int i = 0; i < count; i++) columns.transform(&column[size_t(i) * height], inverse);
    for (int y = 0; y < height; y++)
      for (int i = 0; i < count; i++) grid[size_t(y) * width + x0 + i] = column[size_t(i) * height + y];
  });
}

}  // namespace terrazzo
