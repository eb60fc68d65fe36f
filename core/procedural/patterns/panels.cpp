#include <cmath>

#include "core/base/portable_math.h"
#include "core/procedural/pattern_types.h"

namespace terrazzo {

namespace {

using namespace portable;

/// Moulded panels with round corners in courses, each course half a panel on.
class Panels : public Surface {
 public:
  enum Salt : uint64_t { panel_cell = 1, tone, grain, scratch, dirt, dust };

  Panels(const Canvas& canvas, const PatternSpec& spec, const Palette& palette)
      : canvas_(canvas),
        spec_(spec),
        palette_(palette),
        grid_(canvas, spec.scale, rows_per_panel, 2),
        unit_(grid_.cell_height()) {}

  SurfacePoint at(double u, double v) const override {
    const Place p = place(u, v);
    Dice dice(grid_.bits(p.column, p.row, panel_cell));
    const Rgb base = pick_color(palette_.pieces, dice);
    const double shade = 1 + 0.08 * dice.both(), lift = dice.both(), lean = dice.both();
    const double d =
        -rounded_box(p.x, p.y, grid_.cell_width() / 2 - gap * unit_, (0.5 - gap) * unit_, 0.16 * unit_) / unit_;
    const double fine = canvas_.fbm(u, v, 30 / unit_, 3, 0.6, grain);
    const double clouds = canvas_.fbm(u, v, 1.1 / unit_, 4, 0.55, tone);
    const double lines = canvas_.fbm(u, v, 9 / unit_, 4, 0.7, scratch);
    const double round = saturate(d / 0.3);
    const double edge = smoothstep(0.0, 0.02, d);
    const double grime =
        smoothstep(0.0, 0.5, canvas_.fbm(u, v, 1.7 / unit_, 6, 0.6, dirt) + 0.5 * (0.2 - d)) * spec_.wear;

    SurfacePoint s;
    s.height = 0.12 + edge * (0.4 + 0.3 * std::sqrt(round * (2 - round))) + 0.006 * fine +
               spec_.irregularity * 0.04 * (lift + lean * p.x / grid_.cell_width());
    Rgb c = base * (shade + 0.08 * clouds + 0.04 * fine);
    c = mix(c, c * 0.75, spec_.wear * smoothstep(0.28, 0.4, lines));
    c = mix(c, palette_.stain, 0.45 * grime);
    s.color = mix(palette_.joint * (1 + 0.2 * fine), c, edge);
    s.roughness = mix(0.92, mix(0.42 + 0.06 * clouds, 0.8, grime), edge);
    return s;
  }

  uint64_t element(double u, double v) const override {
    const Place p = place(u, v);
    return grid_.id(p.column, p.row);
  }

 private:
  static constexpr double rows_per_panel = 1.6;
  static constexpr double gap = 0.035;  ///< half a joint, in heights of a panel

  struct Place {
    int64_t column, row;
    double x, y;  ///< from the panel's middle, in units of the canvas
  };
  Place place(double u, double v) const {
    const int64_t row = floor_int(v / grid_.cell_height());
    const double along = u / grid_.cell_width() - 0.5 * double(row & 1);
    const int64_t column = floor_int(along);
    return {column, row, (along - double(column) - 0.5) * grid_.cell_width(), v - (double(row) + 0.5) * unit_};
  }

  Canvas canvas_;
  PatternSpec spec_;
  Palette palette_;
  Grid grid_;
  double unit_;  ///< the height of a panel
};

}  // namespace

PatternType panels_pattern() {
  PatternType t;
  t.name = "panels";
  t.summary = "moulded panels with round corners in courses";
  t.scale = 3;
  t.depth = 0.08;
  t.cavity = 0.35;
  t.palettes = {
      {"grey", {rgb(0x8b8f93), rgb(0x969a9d), rgb(0x80858a)}, rgb(0x26282a), rgb(0x4a4338)},
      {"cream", {rgb(0xc8bfa6), rgb(0xd1c8b0), rgb(0xbdb399)}, rgb(0x4c473c), rgb(0x7a6a4d)},
      {"blue", {rgb(0x4f6378), rgb(0x586d83), rgb(0x46596d)}, rgb(0x1c2229), rgb(0x3d3a33)},
  };
  t.make = make_surface<Panels>;
  return t;
}

}  // namespace terrazzo
