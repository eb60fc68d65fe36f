#include "core/procedural/masonry.h"

#include <cmath>

#include "core/base/portable_math.h"

namespace terrazzo {

using namespace portable;

namespace {

enum Salt : uint64_t { edge = 100, chips, top, pits, grain, sand, stain, smear, blotch, bloom };

}  // namespace

Masonry::Masonry(const Canvas& canvas, const PatternSpec& spec, const Palette& palette, const Course& course)
    : canvas_(canvas),
      spec_(spec),
      palette_(palette),
      unit_(course.height),
      per_brick_(1 / course.length),
      mortar_(course.height * course.joint) {}

SurfacePoint Masonry::at(double u, double v, const Brick& b) const {
  Dice dice(b.bits);
  const double loose = mortar_ * 0.28 * spec_.irregularity;
  const double half_w = b.half_width - mortar_ / 2 + loose * dice.both();
  const double half_h = b.half_height - mortar_ / 2 + loose * 0.8 * dice.both();
  const double x = b.x - loose * dice.both();
  const double down = loose * dice.both(), turn = 0.02 * spec_.irregularity * dice.both();
  const double y = b.y - down + x * turn;
  const Rgb base = pick_color(palette_.pieces, dice);
  const double tone = 1 + 0.16 * dice.both(), lift = dice.both(), lean_x = dice.both(), lean_y = dice.both();
  const double burnt = dice.unit(), burnt_side = dice.both(), pitting = dice.unit();

  double d = rounded_box(x, y, half_w, half_h, unit_ * 0.07);
  d += unit_ * (0.012 + 0.03 * spec_.irregularity) * canvas_.fbm(u, v, per_brick_ * 9, 4, 0.6, edge);
  // Chips: where a coarse noise is high, the edge retreats.
  const double chip = canvas_.fbm(u, v, per_brick_ * 4.5, 3, 0.5, chips);
  d += unit_ * 0.34 * spec_.wear * smoothstep(0.22, 0.62, chip);

  const double inside = smoothstep(0.01, -0.075, d / unit_);
  if (d > 0.02 * unit_) return stained(u, v, joint_at(u, v, d));
  const double shoulder = saturate(-d / (unit_ * 0.16));
  const double rounding = 1 - (1 - shoulder) * (1 - shoulder);
  SurfacePoint brick = brick_at(u, v, x / half_w, base, tone, pitting, burnt, burnt_side);
  brick.height += 0.035 * lift + 0.03 * (lean_x * x / half_w + lean_y * y / half_h) * spec_.irregularity;
  brick.height -= 0.13 * (1 - rounding);
  // Edges are rubbed pale, and mortar has been wiped over some faces.
  brick.color = mix(brick.color, brick.color * 1.18 + rgb(0x0a0a08), 0.5 * (1 - rounding) * spec_.wear);
  const double wiped = smoothstep(0.0, 0.45, canvas_.fbm(u, v, per_brick_ * 2.3, 6, 0.66, smear) - 0.16 * shoulder);
  brick.color = mix(brick.color, palette_.joint, 0.5 * wiped);
  brick.roughness = mix(brick.roughness, 0.92, wiped);

  if (shoulder == 1) return stained(u, v, brick);

  const SurfacePoint joint = joint_at(u, v, d);
  SurfacePoint p;
  p.height = mix(joint.height, std::max(brick.height, joint.height), inside);
  p.color = mix(joint.color, brick.color, smoothstep(0.012, -0.03, d / unit_));
  p.roughness = mix(joint.roughness, brick.roughness, inside);
  return stained(u, v, p);
}

SurfacePoint Masonry::brick_at(double u, double v, double along, const Rgb& base, double tone, double pitting,
                               double burnt, double burnt_side) const {
  SurfacePoint p;
  const double waves = canvas_.fbm(u, v, per_brick_ * 3.2, 3, 0.5, top);
  const double fine = canvas_.fbm(u, v, per_brick_ * 22, 5, 0.72, grain);
  const CellPoint hole = canvas_.cells(u, v, per_brick_ * 13, pits);
  Dice dice(hole.bits);
  const bool is_pit = dice.unit() < 0.05 + 0.45 * spec_.wear * pitting * pitting;
  const double wide = dice.unit(), radius = is_pit ? 0.1 + 0.3 * wide * wide : 0;
  const double pit = radius > 0 ? smoothstep(radius, radius * 0.35, hole.nearest + 0.3 * fine + 0.22 * waves) : 0;
  p.height = 0.78 + 0.08 * waves + 0.085 * fine - 0.16 * pit;

  const double patches = canvas_.fbm(u, v, per_brick_ * 2.6, 5, 0.6, blotch);
  Rgb c = base * (tone + 0.34 * patches + 0.20 * fine);
  if (burnt > 0.72) {
    const double fire = smoothstep(-0.5, 1.1, along * burnt_side * 1.2 + 0.8 * patches + 0.4);
    c = mix(c, saturated(c, 0.5) * 0.5, 0.85 * fire);
  }
  // Grog and iron: single pale and dark grains.
  const CellPoint speck = canvas_.cells(u, v, per_brick_ * 48, grain + 32);
  Dice kind(speck.bits);
  const double which = kind.unit(), spot = smoothstep(0.42, 0.2, speck.nearest);
  if (which < 0.12) c = mix(c, c * 0.5, spot * 0.8);
  if (which > 0.9) c = mix(c, c * 1.25 + rgb(0x1c1814), spot * 0.7);
  p.color = mix(c, c * 0.55, pit);
  p.roughness = 0.74 + 0.12 * patches + 0.1 * fine + 0.1 * pit;
  return p;
}

SurfacePoint Masonry::joint_at(double u, double v, double d) const {
  SurfacePoint p;
  const double coarse = canvas_.fbm(u, v, per_brick_ * 6, 4, 0.6, sand);
  const double fine = canvas_.fbm(u, v, per_brick_ * 40, 4, 0.8, sand + 32);
  // The joint is tooled hollow: mortar climbs where it meets a brick.
  const double meniscus = smoothstep(0.09, 0.0, d / unit_);
  p.height = 0.36 + 0.06 * meniscus + 0.07 * coarse + 0.09 * fine;
  const CellPoint sand_grain = canvas_.cells(u, v, per_brick_ * 60, sand + 64);
  Dice kind(sand_grain.bits);
  const double shade = kind.both();
  p.color =
      palette_.joint * (0.92 + 0.22 * coarse + 0.22 * fine + 0.13 * shade * smoothstep(0.6, 0.2, sand_grain.nearest));
  p.roughness = 0.9 + 0.08 * fine;
  return p;
}

SurfacePoint Masonry::stained(double u, double v, SurfacePoint p) const {
  const double damp = smoothstep(0.0, 0.55, canvas_.fbm(u, v, 3, 6, 0.58, stain));
  p.color = mix(p.color, saturated(p.color, 0.85) * 0.66 + palette_.stain * 0.06, 0.75 * spec_.wear * damp);
  p.roughness += 0.05 * damp * spec_.wear;
  const double salt = smoothstep(0.28, 0.7, canvas_.fbm(u, v, 4, 7, 0.66, bloom));
  p.color = mix(p.color, p.color * 0.6 + rgb(0x6a655e), 0.6 * spec_.wear * salt);
  return p;
}

}  // namespace terrazzo
