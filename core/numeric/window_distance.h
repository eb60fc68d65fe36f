#pragma once

#include <cstddef>
#include <cstdint>

namespace terrazzo {

/// The squared distance of two windows of integers: `rows` rows of `row_length` numbers, a multiple of 8. Rows of `a`
/// are contiguous, those of `b` are `b_stride` numbers apart. Differences must not exceed 2^15 - 1, and the distance
/// must be below 2^32. Stops after the row at which the sum reaches `limit`; smaller results are exact. Thread-safe;
/// the same on every machine.
int64_t window_distance(const int16_t* a, const int16_t* b, ptrdiff_t b_stride, int row_length, int rows,
                        int64_t limit);

}  // namespace terrazzo
