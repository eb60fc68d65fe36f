#include <cmath>

#include "core/base/portable_math.h"
#include "core/procedural/pattern_types.h"

namespace terrazzo {

namespace {

using namespace portable;

enum Salt : uint64_t { board_cell = 1, row_cell, edge, wear_patch, dust, scratch };

/// One board: its random numbers, and the place of a point on it, in widths of a board.
struct Board {
  double x, y;  ///< along from its left end, across from its middle
  double length;
  uint64_t bits;
};

/// Floor boards of plain-sawn wood, laid with random joints.
class Planks : public Surface {
 public:
  Planks(const Canvas& canvas, const PatternSpec& spec, const Palette& palette)
      : canvas_(canvas),
        spec_(spec),
        palette_(palette),
        grid_(canvas, spec.scale / boards_long, boards_long),
        unit_(grid_.cell_height()) {}

  SurfacePoint at(double u, double v) const override {
    const int64_t row = floor_int(v / grid_.cell_height());
    const double shift = Dice(grid_.bits(0, row, row_cell)).unit();
    const double place = u / grid_.cell_width() - shift;
    const int64_t column = floor_int(place);
    const double length = grid_.cell_width() / unit_;
    const Board b{(place - double(column)) * length, v / unit_ - double(row) - 0.5, length,
                  grid_.bits(column, row, board_cell)};
    Dice dice(b.bits);
    const double lift = dice.both(), lean = dice.both(), narrow = dice.unit();
    const double side = 0.5 - std::abs(b.y), end = std::min(b.x, b.length - b.x);
    const double gap = 0.011 + 0.012 * spec_.irregularity * narrow;
    const double d = std::min(side, end + 0.004) - gap + 0.006 * canvas_.fbm(u, v, 4 / unit_, 4, 0.6, edge);

    SurfacePoint p = wood_at(u, v, b, dice);
    const double bevel = 1 - saturate(d / 0.045);
    p.height += spec_.irregularity * (0.07 * lift + 0.07 * lean * b.y) - 0.05 * b.y * b.y - 0.22 * bevel * bevel;
    const double grime = smoothstep(0.09, 0.0, d) * (0.3 + 0.7 * spec_.wear);
    p.color = mix(p.color, p.color * 0.5, 0.7 * grime);
    const double inside = smoothstep(-0.014, 0.006, d);
    const double crumbs = canvas_.fbm(u, v, 24 / unit_, 3, 0.7, dust);
    p.height = mix(0.1 + 0.08 * crumbs, p.height, inside);
    p.color = mix(palette_.joint * (0.9 + 0.6 * crumbs), p.color, inside);
    p.roughness = mix(0.92, p.roughness, inside);
    return p;
  }

 private:
  struct Knot {
    double core;  ///< 1 in the knot's middle, 0 outside
    double pull;  ///< how far the grain bends around it
  };
  static Knot knot_at(const Board& b, Dice& dice) {
    const double chance = dice.unit(), at = (0.15 + 0.7 * dice.unit()) * b.length, off = 0.3 * dice.both();
    const double size = 0.05 + 0.07 * dice.unit();
    if (chance > 0.45) return {0, 0};
    const double dx = (b.x - at) * 0.75, dy = b.y - off;
    const double r = std::sqrt(dx * dx + dy * dy) / size;
    const double wobble = 0.25 * gradient_noise(b.x * 14, b.y * 14, b.bits + 8, {});
    return {smoothstep(1.15, 0.55, r + wobble), 1 / (1 + 0.16 * r * r)};
  }

  SurfacePoint wood_at(double u, double v, const Board& b, Dice& dice) const {
    const Rgb base = pick_color(palette_.pieces, dice);
    const double tone = 1 + 0.15 * dice.both(), tilt = 0.05 * dice.both(), heart = 0.7 * dice.both();
    const double rings_wide = 4.5 + 4 * dice.unit();
    const Knot knot = knot_at(b, dice);
    // The growth rings as the saw has cut them: a cone seen from the side, bent by knots and by how the tree grew.
    const double drift = gradient_noise(b.x * 0.35, b.y * 0.8, b.bits, {});
    const double ripple = gradient_noise(b.x * 1.3, b.y * 3, b.bits + 1, {});
    const double across = b.y - heart * 0.5 + tilt * b.x;
    const double field = std::sqrt(across * across + 0.02) + 0.3 * drift + 0.035 * ripple + 0.2 * knot.pull;
    const double phase = field * rings_wide * 1.6;
    const double t = phase - double(floor_int(phase));
    const double strength = 0.65 + 0.5 * gradient_noise(double(floor_int(phase)) * 0.73, b.x * 0.2, b.bits + 2, {});
    const double late = strength * smoothstep(0.15, 0.85, t) * smoothstep(1.0, 0.9, t);
    // Fibres and pores follow the board, much longer than wide.
    const double along = b.x * 1.6, cross = b.y + 0.03 * drift + 0.012 * ripple;
    const double fibre = 0.6 * gradient_noise(along, cross * 34, b.bits + 3, {}) +
                         0.5 * gradient_noise(along * 2.4, cross * 76, b.bits + 4, {});
    const CellPoint vessel = cell_noise(along * 3.2, cross * 62, b.bits + 5, {});
    const double pore = Dice(vessel.bits).unit() < 0.45 ? smoothstep(0.34, 0.12, vessel.nearest) * (1 - 0.6 * late) : 0;
    const double patches = gradient_noise(b.x * 0.6, b.y * 1.4, b.bits + 6, {});

    SurfacePoint p;
    p.height = 0.76 + 0.05 * late + 0.035 * fibre - 0.10 * pore - 0.05 * knot.core;
    Rgb c = base * (tone + 0.10 * patches + 0.12 * fibre);
    c = mix(c, c * 0.66, 0.62 * late);
    c = mix(c, c * 0.55, 0.75 * pore);
    c = mix(c, palette_.stain * (0.9 + 0.4 * fibre), 0.85 * knot.core);
    const double used = canvas_.fbm(u, v, 1.1 / unit_, 6, 0.62, wear_patch);
    const double trodden = smoothstep(0.0, 0.5, used) * spec_.wear, grey = smoothstep(0.05, 0.55, -used) * spec_.wear;
    c = mix(c, saturated(c, 0.55) * 1.12, 0.55 * trodden);
    c = mix(c, c * 0.7, 0.5 * grey);
    const double line = std::abs(canvas_.fbm(u, v, 0.9 / unit_, 2, 0.4, scratch));
    const double scratched = smoothstep(0.006, 0.002, line) *
                             smoothstep(0.1, 0.4, canvas_.noise(u, v, 1 / unit_, scratch + 32)) * spec_.wear;
    p.height -= 0.05 * scratched;
    p.color = mix(c, c * 1.25, 0.4 * scratched);
    p.roughness = 0.5 + 0.2 * trodden + 0.12 * pore + 0.06 * fibre - 0.06 * late + 0.1 * grey;
    return p;
  }

  static constexpr double boards_long = 4;  ///< length of a board in widths

  Canvas canvas_;
  PatternSpec spec_;
  Palette palette_;
  Grid grid_;
  double unit_;  ///< the width of a board
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
