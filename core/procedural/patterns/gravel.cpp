#include <array>
#include <cmath>

#include "core/base/portable_math.h"
#include "core/procedural/cell_table.h"
#include "core/procedural/pattern_types.h"

namespace terrazzo {

namespace {

using namespace portable;

struct Pebble {
  double x, y;                           ///< centre, in cells
  double cosine, sine;                   ///< of its direction
  double inverse_length, inverse_width;  ///< 1 / half axes, in cells
  double base, rise;                     ///< height of its rim, and of its crown above the rim
  double flatness;                       ///< 0: a dome, 1: a flat top
  Rgb color;
  double tone;
  uint64_t bits;
};

struct Layer {
  Grid grid;
  CellTable<Pebble> pebbles;
};

/// The pebble that lies uppermost at a point.
struct Top {
  const Pebble* pebble = nullptr;
  double height = -1;
  double rim = 0;       ///< 0 at the crown, 1 at the outline
  double x = 0, y = 0;  ///< from the centre, along and across, in half axes
};

/// Heaped pebbles: layers of ever smaller stones, the upper hiding the lower, on sand.
class Gravel : public Surface {
 public:
  enum Salt : uint64_t { layer = 1, shape = 20, skin, specks, sand, film };

  Gravel(const Canvas& canvas, const PatternSpec& spec, const Palette& palette)
      : canvas_(canvas), spec_(spec), palette_(palette), per_stone_(spec.scale) {
    // {size of the cells in large stones, share of cells that hold one, lift}
    constexpr std::array<std::array<double, 3>, 8> plan = {{{1.0, 0.62, 0.42},
                                                            {0.8, 0.7, 0.34},
                                                            {0.66, 0.8, 0.28},
                                                            {0.52, 0.85, 0.26},
                                                            {0.42, 0.9, 0.24},
                                                            {0.32, 0.95, 0.22},
                                                            {0.24, 1.0, 0.21},
                                                            {0.18, 1.0, 0.2}}};
    for (size_t k = 0; k < plan.size(); k++) {
      const auto& [size, share, lift] = plan[k];
      const Grid grid(canvas, spec.scale / size, 1);
      layers_.push_back(
          {grid, CellTable<Pebble>(canvas, grid, layer + k,
                                   [&, size = size, share = share, lift = lift](int column, int row, Dice& dice) {
                                     return pebble(column, row, dice, size, share, lift);
                                   })});
    }
  }

  SurfacePoint at(double u, double v) const override {
    const double outline = canvas_.fbm(u, v, per_stone_ * 3.4, 3, 0.5, shape);
    const double fine = canvas_.fbm(u, v, per_stone_ * 20, 4, 0.7, skin);
    const SurfacePoint ground = ground_at(u, v, fine);
    Top top{.height = ground.height};
    for (const Layer& l : layers_) search(l, u / l.grid.cell_width(), v / l.grid.cell_height(), outline, top);
    if (!top.pebble) return ground;
    return stone_at(u, v, top, fine);
  }

 private:
  Pebble pebble(int column, int row, Dice& dice, double size, double share, double lift) const {
    Pebble p{};
    p.x = column + 0.5 + (0.2 + 0.25 * spec_.irregularity) * dice.both();
    p.y = row + 0.5 + (0.2 + 0.25 * spec_.irregularity) * dice.both();
    const double turns = dice.unit();
    p.cosine = cos_turns(turns);
    p.sine = sin_turns(turns);
    const double stretch = 1 + 0.75 * spec_.irregularity * dice.unit();
    const double radius = 0.44 + 0.26 * dice.both() * (0.4 + 0.6 * spec_.irregularity);
    p.inverse_length = 1 / (std::min(0.62, radius * std::sqrt(stretch)));
    p.inverse_width = 1 / (radius / std::sqrt(stretch));
    p.rise = size * radius * (0.55 + 0.25 * dice.unit());
    const double sunk = 0.2 * size * dice.unit();
    const bool is_there = dice.unit() < share;
    p.base = lift - sunk - (is_there ? 0 : 5);
    p.flatness = dice.unit();
    p.color = pick_color(palette_.pieces, dice);
    p.tone = 1 + 0.2 * dice.both();
    p.bits = mix_bits(uint64_t(dice.unit() * 0x1p52));
    return p;
  }

  static void search(const Layer& l, double x, double y, double outline, Top& top) {
    const int64_t row = floor_int(y), column = floor_int(x);
    for (int64_t j = row - 1; j <= row + 1; j++)
      for (int64_t i = column - 1; i <= column + 1; i++) {
        const Pebble& p = l.pebbles.at(i, j);
        if (p.base + p.rise <= top.height) continue;
        const double dx = x - p.x, dy = y - p.y;
        const double a = (dx * p.cosine + dy * p.sine) * p.inverse_length;
        const double b = (dy * p.cosine - dx * p.sine) * p.inverse_width;
        // Between an ellipse and a rounded rectangle, each dented by its own noise.
        const double a2 = a * a, b2 = b * b;
        const double side = (p.bits & 1) ? 1 : -1;
        const double q = std::sqrt(a2 * a2 + b2 * b2 + (2 - 1.2 * p.flatness) * a2 * b2) * (1 + 0.38 * side * outline);
        if (q >= 1) continue;
        const double dome = std::sqrt(1 - q), flat = 1 - q * q * q;
        const double height = p.base + p.rise * mix(dome, 0.85 * flat, 0.55 * p.flatness);
        if (height > top.height) top = {&p, height, q, a, b};
      }
  }

  SurfacePoint stone_at(double u, double v, const Top& top, double fine) const {
    const Pebble& p = *top.pebble;
    Dice dice(p.bits);
    const double veined = dice.unit(), speckled = dice.unit(), smooth = dice.unit(), vein_at = dice.both();
    const double slope = dice.both();
    // Noise in the pebble's own frame, so that neighbours differ.
    const double own = gradient_noise(top.x * 2.3 + 7, top.y * 2.3, p.bits, {});
    const double own_fine = gradient_noise(top.x * 6, top.y * 6 + 3, p.bits + 1, {});
    Rgb c = p.color * (p.tone + 0.16 * own + 0.12 * own_fine + 0.22 * fine);
    if (veined > 0.7) {
      const double at = top.y + slope * top.x * 0.6 + 0.35 * own - 0.5 * vein_at;
      const double vein = smoothstep(0.16, 0.04, std::abs(at)) + 0.6 * smoothstep(0.08, 0.02, std::abs(at - 0.4));
      c = mix(c, c * 0.5 + rgb(0x7a756c), 0.6 * vein);
    }
    const CellPoint grain = canvas_.cells(u, v, per_stone_ * 36, specks);
    const double which = Dice(grain.bits).both(), spot = smoothstep(0.5, 0.15, grain.nearest);
    c = c * (1 + (0.15 + 0.5 * speckled) * which * which * which * spot);
    const double dust = smoothstep(0.55, 1.0, top.rim + 0.35 * fine) * (0.25 + 0.6 * spec_.wear);
    c = mix(c, palette_.joint * 0.8, 0.6 * dust);
    const double grime = smoothstep(0.0, 0.5, canvas_.fbm(u, v, 3, 5, 0.6, film));
    c = mix(c, mix(c * 0.75, palette_.stain * 0.8, 0.2), 0.6 * grime * spec_.wear);
    SurfacePoint s;
    s.height = top.height + 0.022 * fine * (1.3 - smooth) + 0.03 * own;
    s.color = c;
    s.roughness = 0.5 + 0.3 * (1 - smooth) + 0.2 * dust + 0.14 * fine;
    return s;
  }

  SurfacePoint ground_at(double u, double v, double fine) const {
    const double coarse = canvas_.fbm(u, v, per_stone_ * 4, 4, 0.6, sand);
    const CellPoint grain = canvas_.cells(u, v, per_stone_ * 26, sand + 32);
    Dice dice(grain.bits);
    const double bump = smoothstep(0.6, 0.1, grain.nearest), shade = dice.both();
    SurfacePoint p;
    p.height = 0.07 + 0.05 * coarse + 0.03 * bump + 0.02 * fine;
    p.color = palette_.joint * (0.75 + 0.2 * coarse + 0.25 * shade * bump + 0.2 * fine);
    p.roughness = 0.93;
    return p;
  }

  Canvas canvas_;
  PatternSpec spec_;
  Palette palette_;
  double per_stone_;
  std::vector<Layer> layers_;
};

}  // namespace

PatternType gravel_pattern() {
  PatternType t;
  t.name = "gravel";
  t.summary = "heaped pebbles of many sizes on sand";
  t.scale = 9;
  t.depth = 0.62;
  t.cavity = 0.6;
  t.palettes = {
      {"river",
       {rgb(0x8d8a84), rgb(0xa69a88), rgb(0x6c6e70), rgb(0xb5ada0), rgb(0x8a6f5c), rgb(0x767a74), rgb(0xcac3b6),
        rgb(0x5a5552)},
       rgb(0x8a7a63),
       rgb(0x4d4a3a)},
      {"grey",
       {rgb(0x7d7f82), rgb(0x95979a), rgb(0x66686c), rgb(0xa9a9a8), rgb(0x55575a)},
       rgb(0x77746e),
       rgb(0x3d4038)},
      {"ochre",
       {rgb(0xb58c55), rgb(0xc7a676), rgb(0x9a7142), rgb(0xd8c29a), rgb(0x8a6a4c), rgb(0xa89a86)},
       rgb(0xa88a5e),
       rgb(0x5a4a30)},
  };
  t.make = make_surface<Gravel>;
  return t;
}

}  // namespace terrazzo
