#pragma once

#include <complex>
#include <vector>

namespace terrazzo {

/// The smallest power of two that is at least n.
int padded_length(int n);

/// The discrete Fourier transform of power-of-two length (Cooley & Tukey 1965), the same bits on every machine: its
/// twiddle factors come from square roots, not from a library's sine. Immutable; thread-safe.
class Fft {
 public:
  explicit Fft(int length);
  int length() const { return length_; }
  /// In place. The inverse is not divided by the length.
  void transform(std::complex<double>* values, bool inverse) const;

 private:
  int length_;
  /// exp(-2 pi i k / order), k < order / 2, for the orders 2, 4, ... length one after another.
  std::vector<std::complex<double>> twiddles_;
  std::vector<int> reversed_;
};

/// A grid of width * height complex numbers, row by row, transformed along both axes.
void transform_2d(std::vector<std::complex<double>>& grid, int width, int height, bool inverse);

/// The same in less time if only the first `filled_rows` rows hold anything but 0, and only the first `wanted_columns`
/// columns of the result are asked for; others are left undefined.
void transform_2d(std::vector<std::complex<double>>& grid, int width, int height, bool inverse, int filled_rows,
                  int wanted_columns);

}  // namespace terrazzo
