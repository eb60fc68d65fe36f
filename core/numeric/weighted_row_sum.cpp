#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/numeric/weighted_row_sum.cpp"
#include "core/numeric/weighted_row_sum.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace terrazzo {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Every sum takes its products one by one, rounded each time: the same bits whatever the vectors' length.
HWY_ATTR void weighted_row_sum(float* sums, size_t length, const float* rows, size_t row_stride, const float* factors,
                               size_t factor_stride, size_t count) {
  const hn::CappedTag<float, 8> d;
  const size_t lanes = hn::Lanes(d);
  size_t k = 0;
  // Several vectors of sums stay in registers, and no addition waits for the one before.
  for (; k + 4 * lanes <= length; k += 4 * lanes) {
    auto s0 = hn::LoadU(d, sums + k), s1 = hn::LoadU(d, sums + k + lanes);
    auto s2 = hn::LoadU(d, sums + k + 2 * lanes), s3 = hn::LoadU(d, sums + k + 3 * lanes);
    for (size_t r = 0; r < count; r++) {
      const float* row = rows + r * row_stride + k;
      const auto factor = hn::Set(d, factors[r * factor_stride]);
      s0 = hn::Add(s0, hn::Mul(factor, hn::LoadU(d, row)));
      s1 = hn::Add(s1, hn::Mul(factor, hn::LoadU(d, row + lanes)));
      s2 = hn::Add(s2, hn::Mul(factor, hn::LoadU(d, row + 2 * lanes)));
      s3 = hn::Add(s3, hn::Mul(factor, hn::LoadU(d, row + 3 * lanes)));
    }
    hn::StoreU(s0, d, sums + k);
    hn::StoreU(s1, d, sums + k + lanes);
    hn::StoreU(s2, d, sums + k + 2 * lanes);
    hn::StoreU(s3, d, sums + k + 3 * lanes);
  }
  for (size_t r = 0; r < count; r++)
    for (size_t i = k; i < length; i++) sums[i] += factors[r * factor_stride] * rows[r * row_stride + i];
}

}  // namespace HWY_NAMESPACE
}  // namespace terrazzo
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace terrazzo {

HWY_EXPORT(weighted_row_sum);

void weighted_row_sum(float* sums, int length, const float* rows, size_t row_stride, const float* factors,
                      size_t factor_stride, size_t count) {
  HWY_DYNAMIC_DISPATCH(weighted_row_sum)(sums, size_t(length), rows, row_stride, factors, factor_stride, count);
}

}  // namespace terrazzo
#endif
