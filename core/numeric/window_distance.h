#pragma once

#include <cstddef>
#include <cstdint>

namespace terrazzo {

/// The squared distance of two windows of vectors of whole numbers: `rows` rows of `row_length` numbers each, a
/// multiple of 8, the rows of `a` one after another, those of `b` `b_stride` numbers apart. No two numbers may be
/// farther apart than 2^15 - 1, and the distance must be below 2^32. Rows are added until the sum has reached `limit`:
/// below it the result is exact. Thread-safe; the same on every machine.
int64_t window_distance(const int16_t* a, const int16_t* b, ptrdiff_t b_stride, int row_length, int rows,
                        int64_t limit);

}  // namespace terrazzo
