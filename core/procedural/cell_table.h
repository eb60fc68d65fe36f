#pragma once

#include <vector>

#include "core/base/portable_math.h"
#include "core/procedural/surface.h"

namespace terrazzo {

/// Precomputed objects, one per cell of a grid over a canvas, with a margin of a few cells around it; on a wrapping
/// canvas the margin repeats the objects. Positions are in cells. Immutable.
template <typename T>
class CellTable {
 public:
  /// `make(column, row, dice)` is called once per cell; equal cells of a wrapped canvas get equal dice.
  template <typename Make>
  CellTable(const Canvas& canvas, const Grid& grid, uint64_t salt, Make make) {
    columns_ = int(portable::floor_int(1 / grid.cell_width() + 0.999)) + 2 * margin;
    rows_ = int(portable::floor_int(canvas.aspect() / grid.cell_height() + 0.999)) + 2 * margin;
    for (int j = 0; j < rows_; j++)
      for (int i = 0; i < columns_; i++) {
        Dice dice(grid.bits(i - margin, j - margin, salt));
        things_.push_back(make(i - margin, j - margin, dice));
      }
  }
  /// The cell may lie up to `margin` outside the canvas.
  const T& at(int64_t column, int64_t row) const {
    return things_[size_t(row + margin) * size_t(columns_) + size_t(column + margin)];
  }
  bool holds(int64_t column, int64_t row) const {
    return column >= -margin && row >= -margin && column < columns_ - margin && row < rows_ - margin;
  }
  static constexpr int margin = 6;

 private:
  int columns_ = 0;
  int rows_ = 0;
  std::vector<T> things_;
};

}  // namespace terrazzo
