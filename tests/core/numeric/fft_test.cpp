#include "core/numeric/fft.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include <doctest/doctest.h>

#include "core/base/hash.h"

using namespace terrazzo;

namespace {

std::vector<std::complex<double>> noise(size_t n) {
  std::vector<std::complex<double>> out(n);
  for (size_t i = 0; i < n; i++) out[i] = {unit_double(random_bits(1, i, 0)), unit_double(random_bits(1, i, 1))};
  return out;
}

}  // namespace

TEST_CASE("the fast Fourier transform agrees with the sum that defines it") {
  for (const int n : {1, 2, 8, 64}) {
    const auto values = noise(n);
    auto transformed = values;
    Fft(n).transform(transformed.data(), false);
    for (int k = 0; k < n; k++) {
      std::complex<double> sum = 0;
      for (int j = 0; j < n; j++) sum += values[j] * std::polar(1.0, -2 * std::numbers::pi * j * k / n);
      CHECK(std::abs(transformed[k] - sum) < 1e-12 * n);
    }
  }
}

TEST_CASE("the inverse transform of a grid gives the grid times its area") {
  const auto values = noise(32 * 16);
  auto grid = values;
  transform_2d(grid, 32, 16, false);
  CHECK(std::abs(grid[0] - std::accumulate(values.begin(), values.end(), std::complex<double>())) < 1e-9);
  transform_2d(grid, 32, 16, true);
  double worst = 0;
  for (size_t i = 0; i < grid.size(); i++) worst = std::max(worst, std::abs(grid[i] / 512.0 - values[i]));
  CHECK(worst < 1e-13);
}

TEST_CASE("rows of zeros and columns that nobody wants change nothing of what is wanted") {
  constexpr int width = 16, height = 32, filled = 5, wanted = 11;
  std::vector<std::complex<double>> grid = noise(width * height);
  std::fill(grid.begin() + ptrdiff_t{filled} * width, grid.end(), 0);
  std::vector<std::complex<double>> whole = grid;
  transform_2d(whole, width, height, false);
  transform_2d(grid, width, height, false, filled, wanted);
  for (int y = 0; y < height; y++)
    for (int x = 0; x < wanted; x++) REQUIRE(grid[size_t(y) * width + x] == whole[size_t(y) * width + x]);
}

TEST_CASE("lengths are padded to a power of two") {
  CHECK(padded_length(1) == 1);
  CHECK(padded_length(576) == 1024);
  CHECK(padded_length(1024) == 1024);
}
