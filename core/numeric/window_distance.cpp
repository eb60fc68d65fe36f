#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/numeric/window_distance.cpp"
#include "core/numeric/window_distance.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace terrazzo {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR
uint32_t row_distance(const int16_t* a, const int16_t* b, size_t length) {
  uint32_t sum = 0;
  for (size_t i = 0; i < length; i++) {
    const int difference = a[i] - b[i];
    sum += uint32_t(difference * difference);
  }
  return sum;
}
#else
/// The sums of the lanes may wrap around; the row's own sum does not.
HWY_INLINE HWY_ATTR uint32_t row_distance(const int16_t* a, const int16_t* b, size_t length) {
  const hn::CappedTag<int16_t, 16> d16;
  const hn::RepartitionToWide<decltype(d16)> d32;
  auto even = hn::Zero(d32), odd = hn::Zero(d32);
  size_t i = 0;
  for (; i + hn::Lanes(d16) <= length; i += hn::Lanes(d16)) {
    const auto difference = hn::Sub(hn::LoadU(d16, a + i), hn::LoadU(d16, b + i));
    even = hn::ReorderWidenMulAccumulate(d32, difference, difference, even, odd);
  }
  auto sum = uint32_t(hn::GetLane(hn::SumOfLanes(d32, hn::Add(even, odd))));
  if (i < length) {  // half a vector
    const hn::Full128<int16_t> half16;
    const hn::Full128<int32_t> half32;
    auto rest = hn::Zero(half32), other = hn::Zero(half32);
    const auto difference = hn::Sub(hn::LoadU(half16, a + i), hn::LoadU(half16, b + i));
    rest = hn::ReorderWidenMulAccumulate(half32, difference, difference, rest, other);
    sum += uint32_t(hn::GetLane(hn::SumOfLanes(half32, hn::Add(rest, other))));
  }
  return sum;
}
#endif

HWY_ATTR int64_t window_distance(const int16_t* a, const int16_t* b, ptrdiff_t b_stride, size_t row_length, int rows,
                                 int64_t limit) {
  int64_t sum = 0;
  for (int y = 0; y < rows && sum < limit; y++, a += row_length, b += b_stride) sum += row_distance(a, b, row_length);
  return sum;
}

}  // namespace HWY_NAMESPACE
}  // namespace terrazzo
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace terrazzo {

HWY_EXPORT(window_distance);

int64_t window_distance(const int16_t* a, const int16_t* b, ptrdiff_t b_stride, int row_length, int rows,
                        int64_t limit) {
  return HWY_DYNAMIC_DISPATCH(window_distance)(a, b, b_stride, size_t(row_length), rows, limit);
}

}  // namespace terrazzo
#endif
