#include <cmath>

#include "core/base/portable_math.h"
#include "core/procedural/pattern_types.h"

namespace terrazzo {

namespace {

using namespace portable;

/// Fish-scale slates: rows of tongues with round ends, each row over the one below, half a slate on.
class Slates : public Surface {
 public:
  enum Salt : uint64_t { slate_cell = 1, edge, chips, riven, grain, cloud, damp, lichen };

  Slates(const Canvas& canvas, const PatternSpec& spec, const Palette& palette)
      : canvas_(canvas),
        spec_(spec),
        palette_(palette),
        grid_(canvas, spec.scale, rows_per_slate, 2),
        unit_(grid_.cell_width()) {}

  SurfacePoint at(double u, double v) const override {
    const double ragged = 0.008 * (0.4 + spec_.irregularity) * canvas_.fbm(u, v, 8 / unit_, 4, 0.6, edge) -
                          0.06 * spec_.wear * smoothstep(0.25, 0.6, canvas_.fbm(u, v, 3 / unit_, 4, 0.55, chips));
    const double gap = 0.012 + 0.01 * spec_.irregularity;
    const Place p = uppermost(u, v, [&](const Place& q) { return inside(q) + ragged - gap > 0; });
    return slate_at(u, v, p, inside(p) + ragged - gap);
  }

  uint64_t element(double u, double v) const override {
    const Place p = uppermost(u, v, [](const Place& q) { return inside(q) > 0; });
    return grid_.id(p.column, p.row);
  }

 private:
  static constexpr double rows_per_slate = 1.7;
  static constexpr double roundness = 0.5;  ///< height of the round end, in widths

  struct Place {
    int64_t column, row;
    double x, up;  ///< from the middle of the slate's lower end, in widths of a slate
    uint64_t bits;
  };

  /// The slate of a row whose column holds the point.
  Place place_in(double u, double v, int64_t row) const {
    const double along = u / unit_ - 0.5 * double(row & 1);
    const int64_t column = floor_int(along);
    const uint64_t bits = grid_.bits(column, row, slate_cell);
    Dice dice(bits);
    const double hung = 0.05 * spec_.irregularity * dice.both(), turn = 0.05 * spec_.irregularity * dice.both();
    const double x = along - double(column) - 0.5;
    const double up = (double(row + 1) * grid_.cell_height() - v) / unit_ + hung + turn * x;
    return {column, row, x, up, bits};
  }

  /// How far a point lies inside a slate's outline, in widths.
  static double inside(const Place& p) {
    if (p.up >= roundness) return 0.5 - std::abs(p.x);
    const double y = (roundness - p.up) * 0.5 / roundness;
    return 0.5 - std::sqrt(p.x * p.x + y * y);
  }

  /// Upper rows lie over lower ones: the first that covers the point.
  template <typename Covers>
  Place uppermost(double u, double v, const Covers& covers) const {
    const int64_t last = floor_int(v / grid_.cell_height()) + 2;
    for (int64_t row = last - 3; row < last; row++)
      if (const Place p = place_in(u, v, row); covers(p)) return p;
    return place_in(u, v, last);
  }

  SurfacePoint slate_at(double u, double v, const Place& p, double d) const {
    Dice dice(p.bits + 1);
    const Rgb base = pick_color(palette_.pieces, dice);
    const double tone = 1 + 0.2 * dice.both(), lift = dice.both(), lean = dice.both(), warm = dice.both();
    const double su = u + dice.unit(), sv = v + dice.unit() * canvas_.aspect();
    const double steps = canvas_.fbm(su, sv, 1.3 / unit_, 5, 0.52, riven) * 6;
    const double whole = double(floor_int(steps)), layer = whole + smoothstep(0.3, 0.7, steps - whole);
    const double fine = canvas_.fbm(su, sv, 16 / unit_, 5, 0.65, grain);
    const double clouds = canvas_.fbm(su, sv, 1.2 / unit_, 6, 0.6, cloud);
    const double thin = 1 - saturate(d / 0.03);
    SurfacePoint s;
    // Each slate rests on the row below: its lower end stands highest.
    const double row_height = grid_.cell_height() / unit_;
    s.height = 0.8 - 0.3 * p.up / row_height + 0.028 * layer + 0.03 * fine - 0.05 * thin * thin +
               spec_.irregularity * (0.05 * lift + 0.08 * lean * p.x);
    Rgb c = base * (tone + 0.22 * clouds + 0.16 * fine + 0.03 * layer);
    c = c + Rgb{0.016, 0.002, -0.014} * (warm + 1.5 * clouds);
    // Broken edges are pale, and what the upper row shades stays wet and dark.
    c = mix(c, c * 1.3 + rgb(0x0c0c0c), 0.5 * thin * (0.3 + 0.7 * spec_.wear));
    const double wet = smoothstep(0.0, 0.5, canvas_.fbm(u, v, 2.5, 6, 0.58, damp));
    c = mix(c, c * 0.72, 0.6 * wet * spec_.wear);
    const double patch = canvas_.fbm(u, v, 1.1 / unit_, 7, 0.66, lichen);
    const double grown = smoothstep(0.26, 0.4, patch + 0.2 * (spec_.wear - 0.5)) * spec_.wear;
    s.height += 0.02 * grown;
    s.color = mix(c, palette_.stain * (0.95 + 0.5 * fine), 0.7 * grown);
    s.roughness = mix(0.56 + 0.14 * fine - 0.1 * wet * spec_.wear, 0.95, grown);
    if (d < 0) {
      s.color = mix(s.color, palette_.joint, smoothstep(0, -0.015, d));
      s.height += 0.6 * std::max(d, -0.3);
    }
    return s;
  }

  Canvas canvas_;
  PatternSpec spec_;
  Palette palette_;
  Grid grid_;
  double unit_;  ///< the width of a slate
};

}  // namespace

PatternType slates_pattern() {
  PatternType t;
  t.name = "slates";
  t.summary = "fish-scale slates: overlapping rows of round tongues";
  t.scale = 5;
  t.depth = 0.14;
  t.cavity = 0.5;
  t.palettes = {
      {"welsh", {rgb(0x565c68), rgb(0x636873), rgb(0x4a505c), rgb(0x5f5d66)}, rgb(0x1f2125), rgb(0x8a8d6c)},
      {"green", {rgb(0x66706a), rgb(0x737c72), rgb(0x58635f), rgb(0x6d6f62)}, rgb(0x23261f), rgb(0x9a9468)},
      {"clay", {rgb(0x9a5a41), rgb(0xa7684c), rgb(0x864c39), rgb(0x93604b)}, rgb(0x2b1a14), rgb(0x7d7a52)},
  };
  t.make = make_surface<Slates>;
  return t;
}

}  // namespace terrazzo
