#include "core/synthesis/state/correction_level.h"

namespace terrazzo {

uint64_t CorrectionLevel::control_cost(int pixel, const ExemplarPixel& shown) const {
  const int width = window.part.width, x = window.x(pixel % width) * block, y = window.y(pixel / width) * block;
  uint64_t sum = 0;
  for (int j = 0; j < block; j++)
    for (int i = 0; i < block; i++) {
      int u = shown.x + i, v = shown.y + j;
      exemplar.settle_inside(u, v);
      sum += control->cost(u, v, control->target_near(x + i, y + j));
    }
  return sum;
}

}  // namespace terrazzo
