#pragma once

#include "core/procedural/surface.h"

namespace terrazzo {

/// A board's random bits, and the position of a point on it, in widths of a board.
struct Board {
  double x, y;  ///< along from its left end, across from its middle
  double length;
  uint64_t bits;
};

/// The appearance of boards of plain-sawn wood and their gaps, independent of the layout. Immutable.
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
