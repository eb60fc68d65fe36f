#include "core/base/portable_math.h"
#include "core/procedural/masonry.h"
#include "core/procedural/pattern_types.h"

namespace terrazzo {

namespace {

/// Brick pavers in herringbone bond: blocks of two square cells, alternately lying and standing, each row one cell on.
class Herringbone : public Surface {
 public:
  enum Salt : uint64_t { lying = 1, standing, warp_u, warp_v };

  Herringbone(const Canvas& canvas, const PatternSpec& spec, const Palette& palette)
      : canvas_(canvas),
        grid_(canvas, cells_across(spec.scale, canvas.wraps()), 1, 4),
        masonry_(canvas, spec, palette, {grid_.cell_height(), 2 * grid_.cell_width(), 0.1}),
        bend_(grid_.cell_height() * 0.06 * spec.irregularity) {}

  SurfacePoint at(double u, double v) const override {
    const Block b = block(u, v);
    const double w = grid_.cell_width(), h = grid_.cell_height();
    if (b.lies) return masonry_.at(u, v, {b.x, b.y, w, h / 2, grid_.bits(b.column, b.row, lying)});
    return masonry_.at(u, v, {b.y, b.x, h, w / 2, grid_.bits(b.column, b.row, standing)});
  }

  uint64_t element(double u, double v) const override {
    const Block b = block(u, v);
    return grid_.id(b.column, b.row);
  }

 private:
  struct Block {
    int64_t column, row;  ///< its left or its upper cell
    bool lies;
    double x, y;  ///< from its centre
  };

  Block block(double u, double v) const {
    const double w = grid_.cell_width(), h = grid_.cell_height();
    const double wu = u + bend_ * canvas_.fbm(u, v, 0.6 / w, 3, 0.55, warp_u);
    const double wv = v + bend_ * canvas_.fbm(u, v, 0.6 / w, 3, 0.55, warp_v);
    int64_t column = portable::floor_int(wu / w), row = portable::floor_int(wv / h);
    const int64_t phase = (((column - row) % 4) + 4) % 4;  // left, right, lower, upper
    if (phase == 1) column--;
    if (phase == 2) row--;
    const bool lies = phase < 2;
    return {column, row, lies, wu - (double(column) + (lies ? 1 : 0.5)) * w, wv - (double(row) + (lies ? 0.5 : 1)) * h};
  }

  static double cells_across(double bricks, bool wraps) {
    return wraps ? 4 * std::max(1.0, double(portable::floor_int(bricks / 2 + 0.5))) : bricks * 2;
  }

  Canvas canvas_;
  Grid grid_;
  Masonry masonry_;
  double bend_;
};

}  // namespace

PatternType herringbone_pattern() {
  PatternType t;
  t.name = "herringbone";
  t.summary = "brick pavers in herringbone bond";
  t.scale = 4;
  t.depth = 0.11;
  t.cavity = 0.4;
  t.palettes = {
      {"clay",
       {rgb(0x8d5343), rgb(0x9c6450), rgb(0x7a4639), rgb(0xa8755a), rgb(0x70483f)},
       rgb(0x8f8473),
       rgb(0x332f26)},
      {"buff", {rgb(0xa89070), rgb(0xb59f80), rgb(0x978062), rgb(0xa3886c)}, rgb(0x85796a), rgb(0x37332a)},
      {"graphite", {rgb(0x55555a), rgb(0x636265), rgb(0x48494d), rgb(0x6b6864)}, rgb(0x7b7871), rgb(0x2b2a28)},
  };
  t.make = make_surface<Herringbone>;
  return t;
}

}  // namespace terrazzo
