#include "core/base/portable_math.h"
#include "core/procedural/pattern_types.h"
#include "core/procedural/wood.h"

namespace terrazzo {

namespace {

using namespace portable;

/// Floor boards of plain-sawn wood, laid with random joints.
class Planks : public Surface {
 public:
  enum Salt : uint64_t { board_cell = 1, row_cell };

  Planks(const Canvas& canvas, const PatternSpec& spec, const Palette& palette)
      : grid_(canvas, spec.scale / boards_long, boards_long),
        unit_(grid_.cell_height()),
        wood_(canvas, spec, palette, unit_) {}

  SurfacePoint at(double u, double v) const override {
    const Place p = place(u, v);
    const double length = grid_.cell_width() / unit_;
    return wood_.at(u, v,
                    {(p.along - double(p.column)) * length, v / unit_ - double(p.row) - 0.5, length,
                     grid_.bits(p.column, p.row, board_cell)});
  }

  uint64_t element(double u, double v) const override {
    const Place p = place(u, v);
    return grid_.id(p.column, p.row);
  }

 private:
  struct Place {
    int64_t column, row;
    double along;  ///< in columns
  };

  Place place(double u, double v) const {
    const int64_t row = floor_int(v / grid_.cell_height());
    const double shift = Dice(grid_.bits(0, row, row_cell)).unit();
    const double along = u / grid_.cell_width() - shift;
    return {floor_int(along), row, along};
  }

  static constexpr double boards_long = 4;  ///< length of a board in widths

  Grid grid_;
  double unit_;  ///< the width of a board
  Wood wood_;
};

}  // namespace

PatternType planks_pattern() {
  PatternType t;
  t.name = "planks";
  t.summary = "floor boards of plain-sawn wood; scale counts boards down";
  t.scale = 6;
  t.depth = 0.06;
  t.cavity = 0.4;
  t.palettes = {
      {"oak", {rgb(0xab8459), rgb(0xb8926a), rgb(0x9a744b), rgb(0xa47e58)}, rgb(0x241a11), rgb(0x54381f)},
      {"walnut", {rgb(0x6a4a34), rgb(0x7a583f), rgb(0x5a3e2c), rgb(0x70523f)}, rgb(0x140d08), rgb(0x2d1c12)},
      {"weathered", {rgb(0x8b857a), rgb(0x99938a), rgb(0x7a756c), rgb(0x8f8375)}, rgb(0x211e1a), rgb(0x4a423a)},
  };
  t.make = make_surface<Planks>;
  return t;
}

}  // namespace terrazzo
