#pragma once

#include <cstddef>

namespace terrazzo {

/// Adds `count` rows of `length` numbers, each times its factor, to the sums, one row after the other. `row_stride` and
/// `factor_stride`: from one to the next. The sums must be apart from both.
void weighted_row_sum(float* sums, int length, const float* rows, size_t row_stride, const float* factors,
                      size_t factor_stride, size_t count);

}  // namespace terrazzo
