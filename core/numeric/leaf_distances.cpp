#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/numeric/leaf_distances.cpp"
#include "core/numeric/leaf_distances.h"

#include <algorithm>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace terrazzo {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Every sum takes its squares one by one, rounded each time: the same bits whatever the vectors' length.
HWY_ATTR bool leaf_distances(const float* values, const float* query, int dimensions, float limit, float* squared) {
  const hn::CappedTag<float, leaf_points> d;
  constexpr int at_once = 8;  // dimensions until distances are looked at
  for (int i = 0; i < leaf_points; i++) squared[i] = 0;
  for (int first = 0; first < dimensions; first += at_once) {
    const int end = std::min(first + at_once, dimensions);
    bool any = false;
    for (size_t i = 0; i < leaf_points; i += hn::Lanes(d)) {
      auto sum = hn::LoadU(d, squared + i);
      for (int k = first; k < end; k++) {
        const auto apart = hn::Sub(hn::LoadU(d, values + size_t(k) * leaf_points + i), hn::Set(d, query[k]));
        sum = hn::Add(sum, hn::Mul(apart, apart));
      }
      hn::StoreU(sum, d, squared + i);
      any |= !hn::AllFalse(d, hn::Le(sum, hn::Set(d, limit)));
    }
    if (!any) return false;
  }
  return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace terrazzo
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace terrazzo {

HWY_EXPORT(leaf_distances);

bool leaf_distances(const float* values, const float* query, int dimensions, float limit, float* squared) {
  return HWY_DYNAMIC_DISPATCH(leaf_distances)(values, query, dimensions, limit, squared);
}

}  // namespace terrazzo
#endif
