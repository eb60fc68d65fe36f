#pragma once

#include <algorithm>
#include <cstddef>

#include "core/base/geometry.h"

namespace terrazzo {

/// The smallest rectangle around all pixels for which `test(y * width + x)` holds; empty if there are none.
template <typename Test>
Rect bounds(Size size, const Test& test) {
  int left = size.width, right = 0, top = size.height, bottom = 0;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++)
      if (test(size_t(y) * size_t(size.width) + size_t(x))) {
        left = std::min(left, x);
        right = std::max(right, x + 1);
        top = std::min(top, y);
        bottom = y + 1;
      }
  return bottom == 0 ? Rect{} : Rect{left, top, right - left, bottom - top};
}

}  // namespace terrazzo
