#include <cmath>

#include "core/base/portable_math.h"
#include "core/procedural/pattern_types.h"

namespace terrazzo {

namespace {

using namespace portable;

/// Glazed square floor tiles with cement grout.
class Tiles : public Surface {
 public:
  enum Salt : uint64_t { tile_cell = 1, edge, chips, glaze, cloud, craze, craze_at, grout, grime, smudge, specks };

  Tiles(const Canvas& canvas, const PatternSpec& spec, const Palette& palette)
      : canvas_(canvas), spec_(spec), palette_(palette), grid_(canvas, spec.scale, 1), unit_(grid_.cell_width()) {}

  SurfacePoint at(double u, double v) const override {
    const int64_t column = floor_int(u / grid_.cell_width()), row = floor_int(v / grid_.cell_height());
    Dice dice(grid_.bits(column, row, tile_cell));
    const double loose = unit_ * 0.008 * spec_.irregularity;
    const double x0 = u - (double(column) + 0.5) * grid_.cell_width() + loose * dice.both();
    const double y0 = v - (double(row) + 0.5) * grid_.cell_height() + loose * dice.both();
    const double turn = 0.012 * spec_.irregularity * dice.both();
    const double x = x0 + turn * y0, y = y0 - turn * x0;
    double d = rounded_box(x, y, grid_.cell_width() * 0.472, grid_.cell_height() * 0.472, unit_ * 0.025) / unit_;
    d += 0.004 * canvas_.fbm(u, v, 9 / unit_, 3, 0.6, edge);
    const double chip = smoothstep(0.3, 0.5, canvas_.fbm(u, v, 3.2 / unit_, 4, 0.55, chips)) *
                        smoothstep(-0.07, -0.005, d) * spec_.wear;

    const SurfacePoint joint = joint_at(u, v, d);
    const double inside = smoothstep(0.0, -0.014, d);
    if (inside <= 0) return joint;
    const SurfacePoint tile = tile_at(u, v, x / unit_, y / unit_, d, chip, dice);
    SurfacePoint p;
    p.height = mix(joint.height, std::max(tile.height, joint.height), inside);
    p.color = mix(joint.color, tile.color, inside);
    p.roughness = mix(joint.roughness, tile.roughness, inside);
    return p;
  }

  uint64_t element(double u, double v) const override {
    return grid_.id(floor_int(u / grid_.cell_width()), floor_int(v / grid_.cell_height()));
  }

 private:
  SurfacePoint tile_at(double u, double v, double x, double y, double d, double chip, Dice& dice) const {
    const Rgb base = pick_color(palette_.pieces, dice);
    const double tone = 1 + 0.07 * dice.both(), lift = dice.both(), lean_x = dice.both(), lean_y = dice.both();
    const uint64_t own = uint64_t(dice.unit() * 0x1p52);
    // Noise in the tile's own frame: every tile was glazed separately.
    const double pool = gradient_noise(x * 2.2, y * 2.2, own, {}) + 0.5 * gradient_noise(x * 5.1, y * 5.1, own + 1, {});
    const double orange_peel = canvas_.fbm(u, v, 16 / unit_, 3, 0.6, glaze);
    const double clouds = canvas_.fbm(u, v, 2.1 / unit_, 6, 0.62, cloud);
    const double cushion = 1 - saturate(-d / 0.05);
    SurfacePoint p;
    p.height = 0.76 - 0.2 * cushion * cushion + 0.03 * pool + 0.012 * orange_peel +
               spec_.irregularity * (0.05 * lift + 0.07 * (lean_x * x + lean_y * y));
    // Glaze gathers in the hollows, deeper in colour, and runs thin off the edges.
    const double thin = smoothstep(0.25, 1.0, cushion + 0.35 * pool);
    Rgb c = saturated(base, 1 - 0.22 * pool) * (tone + 0.10 * pool + 0.16 * clouds);
    c = mix(c, palette_.stain, 0.38 * thin);
    const CellPoint speck = canvas_.cells(u, v, 26 / unit_, specks);
    const double dark = Dice(speck.bits).unit() < 0.1 ? smoothstep(0.22, 0.1, speck.nearest) : 0;
    c = mix(c, c * 0.62, 0.7 * dark);
    const double craze_here = smoothstep(-0.1, 0.35, canvas_.fbm(u, v, 1.1 / unit_, 3, 0.5, craze_at)) * spec_.wear;
    const double bend = 0.02 * unit_ * orange_peel;
    const CellPoint net = canvas_.cells(u + bend, v - bend, 7 / unit_, craze);
    const double crack = craze_here * smoothstep(0.045, 0.012, net.second - net.nearest);
    c = mix(c, c * 0.6, 0.55 * crack);
    p.height -= 0.02 * crack;
    // Where the edge is chipped, the fired clay shows.
    const double grain = canvas_.fbm(u, v, 30 / unit_, 3, 0.7, grout + 32);
    p.height -= chip * (0.16 + 0.06 * grain);
    c = mix(c, palette_.stain * (0.92 + 0.25 * grain), chip);
    const double worn = smoothstep(-0.25, 0.5, canvas_.fbm(u, v, 1.6 / unit_, 6, 0.66, smudge));
    const double dirt = smoothstep(0.05, 0.6, canvas_.fbm(u, v, 2.3, 6, 0.6, grime)) * spec_.wear;
    p.color = mix(c, c * 0.8 + rgb(0x0b0a08), 0.7 * dirt);
    p.roughness = 0.2 + 0.2 * worn * (0.5 + spec_.wear) + 0.12 * dirt + 0.12 * crack + 0.05 * orange_peel;
    p.roughness = mix(p.roughness, 0.88, chip);
    return p;
  }

  SurfacePoint joint_at(double u, double v, double d) const {
    const double coarse = canvas_.fbm(u, v, 5 / unit_, 4, 0.6, grout);
    const double fine = canvas_.fbm(u, v, 36 / unit_, 4, 0.8, grout + 64);
    const double dirt = smoothstep(-0.2, 0.45, canvas_.fbm(u, v, 3.1, 5, 0.6, grime + 32)) * spec_.wear;
    SurfacePoint p;
    p.height = 0.34 + 0.1 * smoothstep(0.02, 0.0, d) + 0.05 * coarse + 0.09 * fine;
    p.color = palette_.joint * ((0.95 + 0.2 * coarse + 0.26 * fine) * (1 - 0.42 * dirt));
    p.roughness = 0.9 + 0.08 * fine;
    return p;
  }

  Canvas canvas_;
  PatternSpec spec_;
  Palette palette_;
  Grid grid_;
  double unit_;  ///< the width of a tile with its joint
};

}  // namespace

PatternType tiles_pattern() {
  PatternType t;
  t.name = "tiles";
  t.summary = "glazed square floor tiles with grout";
  t.scale = 5;
  t.depth = 0.07;
  t.cavity = 0.35;
  t.palettes = {
      {"celadon", {rgb(0x7f9c8c), rgb(0x8aa796), rgb(0x728f82), rgb(0x93a995)}, rgb(0xa39b8d), rgb(0xb8a68a)},
      {"terracotta", {rgb(0xa8623f), rgb(0xb5714a), rgb(0x985639), rgb(0xbb7d58)}, rgb(0x9c9080), rgb(0xc08a66)},
      {"white", {rgb(0xcfccc4), rgb(0xd6d3cb), rgb(0xc6c4be), rgb(0xd2cbbd)}, rgb(0x8a857d), rgb(0xc7b49a)},
      {"cobalt", {rgb(0x2f4f86), rgb(0x3a5c94), rgb(0x274272), rgb(0x4a6a9a)}, rgb(0xa6a29a), rgb(0xb8a68c)},
  };
  t.make = make_surface<Tiles>;
  return t;
}

}  // namespace terrazzo
