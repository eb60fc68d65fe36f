#include "core/numeric/window_distance.h"

#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <hwy/targets.h>

#include "core/base/hash.h"

using namespace terrazzo;

namespace {

constexpr int16_t most = 1600;

std::vector<int16_t> numbers(size_t count, uint64_t seed) {
  std::vector<int16_t> out(count);
  for (size_t i = 0; i < count; i++) out[i] = int16_t(int(below(uint32_t(random_bits(seed, i)), 2 * most + 1)) - most);
  return out;
}

}  // namespace

TEST_CASE("the distance of two windows is the sum of the squares of all differences") {
  constexpr int rows = 7, stride = 131;
  for (const int row_length : {8, 16, 24, 40, 56}) {
    CAPTURE(row_length);
    const std::vector<int16_t> a = numbers(size_t(rows) * row_length, 1), b = numbers(size_t(rows) * stride, 2);
    std::vector<int64_t> sums{0};  // after each row
    for (int y = 0; y < rows; y++) {
      sums.push_back(sums.back());
      for (int x = 0; x < row_length; x++) {
        const int64_t d = a[size_t(y) * row_length + x] - b[size_t(y) * stride + x];
        sums.back() += d * d;
      }
    }
    for (int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
      hwy::SetSupportedTargetsForTest(left & -left);
      CAPTURE(std::string(hwy::TargetName(left & -left)));
      CHECK(window_distance(a.data(), b.data(), stride, row_length, rows, sums.back() + 1) == sums.back());
      CHECK(window_distance(a.data(), b.data(), stride, row_length, rows, sums[3]) == sums[3]);
      CHECK(window_distance(a.data(), b.data(), stride, row_length, rows, sums[3] + 1) == sums[4]);
      CHECK(window_distance(a.data(), a.data(), row_length, row_length, rows, 1) == 0);
    }
    hwy::SetSupportedTargetsForTest(0);
  }
}

TEST_CASE("windows as far apart as can be do not overflow") {
  constexpr int rows = 7, row_length = 56;
  const std::vector<int16_t> low(size_t(rows) * row_length, -most), high(size_t(rows) * row_length, most);
  const int64_t farthest = int64_t{rows} * row_length * (2 * most) * (2 * most);
  CHECK(window_distance(low.data(), high.data(), row_length, row_length, rows, farthest + 1) == farthest);
}
