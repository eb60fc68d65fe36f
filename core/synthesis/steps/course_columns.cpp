#include "core/synthesis/steps/course_columns.h"

#include "core/analysis/space/padded_level.h"

namespace terrazzo {

namespace {

constexpr int difference_shift = 3;  // differences are in eighths of squared appearance units per strip

}  // namespace

int32_t difference(const ColumnLook& a, const ColumnLook& b) {
  int32_t sum = 0;
  for (size_t s = 0; s < a.size(); s++) sum += squared_distance(a[s], b[s]) >> difference_shift;
  return sum;
}

}  // namespace terrazzo
