#pragma once

#include <cstddef>

namespace terrazzo {

/// Adds `count` rows of `length` numbers, each multiplied by its factor, to the sums, in order. `row_stride` and
/// `factor_stride`: distances between consecutive rows and factors. The sums must not overlap either.
void weighted_row_sum(float* sums, int length, const float* rows, size_t row_stride, const float* factors,
                      size_t factor_stride, size_t count);

}  // namespace terrazzo
