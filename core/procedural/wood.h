#pragma once

#include "core/procedural/surface.h"

namespace terrazzo {

/// One board: its random numbers, and the place of a point on it, in widths of a board.
struct Board {
  double x, y;  ///< along from its left end, across from its middle
  double length;
  uint64_t bits;
};

/// What boards of plain-sawn wood and the gaps between them look like, however they are laid. Immutable.
class Wood {
 public:
  /// `width` of a board in units of the canvas.
  Wood(const Canvas& canvas, const PatternSpec& spec, const Palette& palette, double width);
  /// The surface at (u, v), a point of a board or of the gap around it, `end` widths from where the board ends.
  SurfacePoint at(double u, double v, const Board& board, double end) const;
  /// The same for a board whose ends are square.
  SurfacePoint at(double u, double v, const Board& board) const;

 private:
  SurfacePoint board_at(double u, double v, const Board& board, Dice& dice) const;

  Canvas canvas_;
  PatternSpec spec_;
  Palette palette_;
  double unit_;  ///< the width of a board
};

}  // namespace terrazzo
