#include <cmath>

#include "core/base/portable_math.h"
#include "core/procedural/pattern_types.h"
#include "core/procedural/wood.h"

namespace terrazzo {

namespace {

using namespace portable;

/// Parquet in chevrons: columns of slanting boards, cut so that their ends meet those of the next column, mirrored.
class Chevron : public Surface {
 public:
  enum Salt : uint64_t { board_cell = 1 };

  Chevron(const Canvas& canvas, const PatternSpec& spec, const Palette& palette)
      : columns_(whole_pairs(spec.scale, canvas.wraps())),
        grid_(canvas, columns_, boards_per_column),
        cosine_(1 / std::sqrt(1 + rise * rise)),
        width_(grid_.cell_height() * cosine_),
        wood_(canvas, spec, palette, width_) {}

  SurfacePoint at(double u, double v) const override {
    const Place p = place(u, v);
    // Along the board and across it, from the middle of its left edge.
    const double down = p.y - 0.5 * grid_.cell_height();
    const double along = p.x / cosine_ + down * rise * cosine_ * (p.falls ? 1 : -1), across = down * cosine_;
    const double end = std::min(p.x, grid_.cell_width() - p.x);
    return wood_.at(u, v,
                    {along / width_, across / width_, grid_.cell_width() / cosine_ / width_,
                     grid_.bits(p.column, p.row, board_cell)},
                    end / width_);
  }

  uint64_t element(double u, double v) const override {
    const Place p = place(u, v);
    return grid_.id(p.column, p.row);
  }

 private:
  struct Place {
    int64_t column, row;
    double x, y;  ///< from the column's left side, and straight down from the board's upper edge
    bool falls;   ///< towards the right
  };

  Place place(double u, double v) const {
    const int64_t column = floor_int(u / grid_.cell_width());
    const double x = u - double(column) * grid_.cell_width();
    const bool falls = column & 1;
    const double straight = v - rise * (falls ? x : grid_.cell_width() - x);
    const int64_t row = floor_int(straight / grid_.cell_height());
    return {column, row, x, straight - double(row) * grid_.cell_height(), falls};
  }

  /// Columns that mirror each other come in pairs.
  static double whole_pairs(double columns, bool wraps) {
    return wraps ? 2 * std::max(1.0, double(floor_int(columns / 2 + 0.5))) : columns;
  }

  static constexpr double rise = 1;                 ///< of a board: the tangent of its angle
  static constexpr double boards_per_column = 2.6;  ///< in as much height as a column is wide

  double columns_;
  Grid grid_;
  double cosine_;
  double width_;  ///< of a board, across
  Wood wood_;
};

}  // namespace

PatternType chevron_pattern() {
  PatternType t;
  t.name = "chevron";
  t.summary = "parquet boards in columns that mirror each other; scale counts columns";
  t.scale = 4;
  t.depth = 0.05;
  t.cavity = 0.4;
  t.palettes = {
      {"oak", {rgb(0xb08a5e), rgb(0xbd9870), rgb(0x9f7a50), rgb(0xa9845e)}, rgb(0x2a1e13), rgb(0x54381f)},
      {"smoked", {rgb(0x6e5138), rgb(0x7e6045), rgb(0x5c432e), rgb(0x745a42)}, rgb(0x130d08), rgb(0x2b1b11)},
      {"limed", {rgb(0xb5aa98), rgb(0xc2b8a7), rgb(0xa69a87), rgb(0xb0a28c)}, rgb(0x3a342b), rgb(0x6d5a44)},
  };
  t.make = make_surface<Chevron>;
  return t;
}

}  // namespace terrazzo
