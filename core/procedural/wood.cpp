#include "core/procedural/wood.h"

#include <cmath>

#include "core/base/portable_math.h"

namespace terrazzo {

using namespace portable;

namespace {

enum Salt : uint64_t { edge = 3, wear_patch, dust, scratch };

struct Knot {
  double core;  ///< 1 in the knot's middle, 0 outside
  double pull;  ///< how far the grain bends around it
};

Knot knot_at(const Board& b, Dice& dice) {
  const double chance = dice.unit(), at = (0.15 + 0.7 * dice.unit()) * b.length, off = 0.3 * dice.both();
  const double size = 0.05 + 0.07 * dice.unit();
  if (chance > 0.45) return {0, 0};
  const double dx = (b.x - at) * 0.75, dy = b.y - off;
  const double r = std::sqrt(dx * dx + dy * dy) / size;
  const double wobble = 0.25 * gradient_noise(b.x * 14, b.y * 14, b.bits + 8, {});
  return {smoothstep(1.15, 0.55, r + wobble), 1 / (1 + 0.16 * r * r)};
}

}  // namespace

Wood::Wood(const Canvas& canvas, const PatternSpec& spec, const Palette& palette, double width)
    : canvas_(canvas), spec_(spec), palette_(palette), unit_(width) {}

SurfacePoint Wood::at(double u, double v, const Board& b) const {
  return at(u, v, b, std::min(b.x, b.length - b.x));
}

SurfacePoint Wood::at(double u, double v, const Board& b, double end) const {
  Dice dice(b.bits);
  const double lift = dice.both(), lean = dice.both(), narrow = dice.unit();
  const double side = 0.5 - std::abs(b.y);
  const double gap = 0.011 + 0.012 * spec_.irregularity * narrow;
  const double d = std::min(side, end + 0.004) - gap + 0.006 * canvas_.fbm(u, v, 4 / unit_, 4, 0.6, edge);

  SurfacePoint p = board_at(u, v, b, dice);
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

SurfacePoint Wood::board_at(double u, double v, const Board& b, Dice& dice) const {
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
  const double scratched =
      smoothstep(0.006, 0.002, line) * smoothstep(0.1, 0.4, canvas_.noise(u, v, 1 / unit_, scratch + 32)) * spec_.wear;
  p.height -= 0.05 * scratched;
  p.color = mix(c, c * 1.25, 0.4 * scratched);
  p.roughness = 0.5 + 0.2 * trodden + 0.12 * pore + 0.06 * fibre - 0.06 * late + 0.1 * grey;
  return p;
}

}  // namespace terrazzo
