#pragma once

#include <complex>
#include <vector>

namespace terrazzo {

/// The smallest power of two that is at least n.
int padded_length(int n);

/// The discrete Fourier transform of power-of-two length (Cooley & Tukey 1965). Bit-exact on every machine: twiddle
/// factors are computed by square roots instead of a library's sine. Own code since libraries choose their algorithm,
/// and so the last bits, by the machine. Immutable; thread-safe.
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

/// A faster version for grids that are 0 beyond the first `filled_rows` rows, if only the first `wanted_columns`
/// columns of the result are needed; other columns are undefined.
void transform_2d(std::vector<std::complex<double>>& grid, int width, int height, bool inverse, int filled_rows,
                  int wanted_columns);

}  // namespace terrazzo
