#include "core/base/portable_math.h"
#include "core/procedural/masonry.h"
#include "core/procedural/pattern_types.h"

namespace terrazzo {

namespace {

/// A wall of bricks in running bond.
class Bricks : public Surface {
 public:
  enum Salt : uint64_t { brick_cell = 1, warp_u, warp_v };

  Bricks(const Canvas& canvas, const PatternSpec& spec, const Palette& palette)
      : canvas_(canvas),
        grid_(canvas, spec.scale, 2.75, 2),
        masonry_(canvas, spec, palette, {.height = grid_.cell_height(), .length = grid_.cell_width()}),
        bend_(grid_.cell_height() * 0.09 * spec.irregularity) {}

  SurfacePoint at(double u, double v) const override {
    const Place p = place(u, v);
    return masonry_.at(u, v,
                       {.x = p.x,
                        .y = p.y,
                        .half_width = grid_.cell_width() / 2,
                        .half_height = grid_.cell_height() / 2,
                        .bits = grid_.bits(p.column, p.row, brick_cell)});
  }

  uint64_t element(double u, double v) const override {
    const Place p = place(u, v);
    return grid_.id(p.column, p.row);
  }

 private:
  struct Place {
    int64_t column, row;
    double x, y;  ///< from the brick's centre
  };

  Place place(double u, double v) const {
    const double bends = 1.2 / grid_.cell_width();
    const double wu = u + bend_ * canvas_.fbm(u, v, bends, 3, 0.55, warp_u);
    const double wv = v + bend_ * canvas_.fbm(u, v, bends, 3, 0.55, warp_v);
    const int64_t row = portable::floor_int(wv / grid_.cell_height());
    const double shift = 0.5 * double(row & 1);
    const int64_t column = portable::floor_int(wu / grid_.cell_width() - shift);
    return {column, row, wu - (double(column) + 0.5 + shift) * grid_.cell_width(),
            wv - (double(row) + 0.5) * grid_.cell_height()};
  }

  Canvas canvas_;
  Grid grid_;
  Masonry masonry_;
  double bend_;
};

}  // namespace

PatternType bricks_pattern() {
  PatternType t;
  t.name = "bricks";
  t.summary = "a brick wall in running bond";
  t.scale = 4;
  t.depth = 0.1;
  t.cavity = 0.35;
  t.palettes = {
      {"red",
       {rgb(0x87463a), rgb(0x945042), rgb(0x74403a), rgb(0x9c5f4e), rgb(0x80503f)},
       rgb(0xb3a999),
       rgb(0x3a352c)},
      {"stock",
       {rgb(0xb89a68), rgb(0xc4aa7c), rgb(0xa88a5c), rgb(0xb08f6e), rgb(0x94805c)},
       rgb(0xa9a396),
       rgb(0x2e2c28)},
      {"charcoal", {rgb(0x4b494a), rgb(0x5a5654), rgb(0x3e3d41), rgb(0x645a54)}, rgb(0x9a958d), rgb(0x23231f)},
  };
  t.make = make_surface<Bricks>;
  return t;
}

}  // namespace terrazzo
