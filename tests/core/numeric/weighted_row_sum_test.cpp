#include "core/numeric/weighted_row_sum.h"

#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <hwy/targets.h>

#include "core/base/hash.h"

using namespace terrazzo;

TEST_CASE("every instruction set adds products in order, to the bit") {
  const size_t row_stride = 80, factor_stride = 3, count = 21;
  std::vector<float> rows(row_stride * count), factors(factor_stride * count);
  for (size_t i = 0; i < rows.size(); i++) rows[i] = float(unit_double(random_bits(1, i)) - 0.5);
  for (size_t i = 0; i < factors.size(); i++) factors[i] = float(unit_double(random_bits(2, i)) - 0.5);
  for (int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
    hwy::SetSupportedTargetsForTest(left & -left);
    CAPTURE(std::string(hwy::TargetName(left & -left)));
    for (int length = 0; length <= int(row_stride); length++) {
      CAPTURE(length);
      std::vector<float> sums(row_stride, 0.25f), expected = sums;
      for (size_t r = 0; r < count; r++)
        for (int k = 0; k < length; k++) expected[k] += factors[r * factor_stride] * rows[r * row_stride + k];
      weighted_row_sum(sums.data(), length, rows.data(), row_stride, factors.data(), factor_stride, count);
      CHECK(sums == expected);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}
