#pragma once

#include "core/synthesis/state/plane_window.h"

namespace terrazzo {

/// Every second pixel of every second row: the pixels that one sub-pass of a correction corrects.
struct SubPass {
  /// `wanted`: columns and rows of the field; `odd_x`, `odd_y`: 1 for odd positions of the plane, 0 for even ones.
  SubPass(const PlaneWindow& window, const Rect& wanted, int odd_x, int odd_y)
      : first_x(wanted.x + ((window.part.x + wanted.x + odd_x) & 1)),
        first_y(wanted.y + ((window.part.y + wanted.y + odd_y) & 1)),
        columns((wanted.right() - first_x + 1) / 2),
        rows((wanted.bottom() - first_y + 1) / 2) {}
  int x(int column) const { return first_x + 2 * column; }
  int y(int row) const { return first_y + 2 * row; }
  int first_x, first_y;
  int columns, rows;
};

}  // namespace terrazzo
