#include "core/procedural/stone_face.h"

#include <cmath>

#include "core/base/portable_math.h"

namespace terrazzo {

using namespace portable;

namespace {

enum Salt : uint64_t { edge = 200, chips, swell, rough, split, layers, chisel, crystals, sand, lichen, damp, veins };

/// Flat treads and steep risers out of a smooth slope.
double stepped(double x) {
  const double whole = double(floor_int(x));
  return whole + smoothstep(0.35, 0.65, x - whole);
}

}  // namespace

double visible_scale(const PatternSpec& spec) {
  return std::min(spec.scale, double(spec.size.width));
}

StoneFace::StoneFace(const Canvas& canvas, const PatternSpec& spec, const Palette& palette, const StoneLook& look,
                     double unit)
    : canvas_(canvas), spec_(spec), palette_(palette), look_(look), unit_(unit) {}

SurfacePoint StoneFace::at(double u, double v, const StonePlace& place) const {
  Dice dice(place.bits);
  const double gap = look_.joint * (0.5 + 0.2 * spec_.irregularity * dice.both());
  const double ragged = look_.edge * (0.4 + 1.2 * spec_.irregularity);
  double d = place.distance / unit_ - gap + ragged * canvas_.fbm(u, v, 5 / unit_, 4, 0.6, edge);
  const double chip = canvas_.fbm(u, v, 4 / unit_, 3, 0.5, chips);
  d -= 1.5 * look_.edge * spec_.wear * smoothstep(0.2, 0.6, chip);

  const SurfacePoint joint = mortar_at(u, v, d);
  if (d < -0.02) return weathered(u, v, joint, 1);
  const double t = saturate(d / look_.rounding), round = std::sqrt(1 - (1 - t) * (1 - t));
  const SurfacePoint stone = stone_at(u, v, place, round, dice);
  const double soft = std::min(0.02, 0.25 * look_.joint), inside = smoothstep(-soft, soft, d);
  SurfacePoint p;
  p.height = mix(joint.height, std::max(stone.height, joint.height - 0.05), inside);
  p.color = mix(joint.color, stone.color, inside);
  p.roughness = mix(joint.roughness, stone.roughness, inside);
  return weathered(u, v, p, 1 - round);
}

StoneFace::Relief StoneFace::relief_at(double u, double v, const StonePlace& place, Dice& dice) const {
  // Every stone samples another part of the noise, so that nothing continues from one stone to the next.
  const double su = u + dice.unit(), sv = v + dice.unit() * canvas_.aspect();
  const double waves = canvas_.fbm(su, sv, 1.7 / unit_, 4, 0.5, swell);
  const double fine = canvas_.fbm(su, sv, 13 / unit_, 5, 0.68, rough);
  double shape = waves + 0.3 * fine;
  if (look_.facets > 0) {
    const double bend = 0.07 * unit_ * fine;
    const CellPoint facet = canvas_.cells(su + bend, sv - bend, 2.3 / unit_, split);
    Dice plane(facet.bits);
    const double x = plane.both(), y = plane.both();
    const double planes =
        0.9 * (x * facet.dx + y * facet.dy) + 0.25 * plane.both() * smoothstep(0, 0.25, facet.second - facet.nearest);
    shape = mix(shape, planes + 0.4 * waves + 0.3 * fine, look_.facets);
  }
  if (look_.riven > 0) {
    const double slope = 2.6 * canvas_.fbm(su, sv, 1.1 / unit_, 5, 0.5, layers) + 0.3 * waves;
    shape = mix(shape, 0.45 * stepped(1.7 * slope) + 0.22 * fine + 0.15 * waves, look_.riven);
  }
  if (look_.tooled > 0) {
    // Strokes of a broad chisel, side by side along a slanting line.
    const double turn = dice.unit() < 0.5 ? 0.45 : -0.45;
    const double x = place.x / unit_, y = place.y / unit_, across = x - turn * y + 0.02 * fine, along = y + turn * x;
    const uint64_t own = place.bits ^ chisel;
    const double strokes =
        gradient_noise(across * 17, along * 2.2, own, {}) + 0.6 * gradient_noise(across * 33, along * 4, own + 1, {});
    shape += look_.tooled * strokes;
  }
  return {waves, fine, look_.rough * shape};
}

SurfacePoint StoneFace::stone_at(double u, double v, const StonePlace& place, double round, Dice& dice) const {
  const Rgb base = pick_color(palette_.pieces, dice);
  const double tone = 1 + 0.2 * dice.both(), warm = dice.both();
  const double lift = dice.both(), lean_x = dice.both(), lean_y = dice.both();
  const Relief relief = relief_at(u, v, place, dice);
  SurfacePoint p;
  const double low = 0.78 - look_.hollow;
  p.height = low + look_.hollow * round + relief.height * (0.4 + 0.6 * round) +
             spec_.irregularity * (0.06 * lift + 0.08 * (lean_x * place.x + lean_y * place.y) / unit_);

  const double su = u + dice.unit(), sv = v + dice.unit() * canvas_.aspect();
  const double cloud = canvas_.fbm(su, sv, 1.1 / unit_, 6, 0.6, veins);
  Rgb c = base * (tone + 0.30 * cloud + 0.24 * relief.fine + 0.10 * relief.waves);
  c = c + Rgb{0.020, 0.004, -0.018} * (warm + 1.6 * cloud);
  const CellPoint crystal = canvas_.cells(u, v, 36 / unit_, crystals);
  Dice kind(crystal.bits);
  const double which = kind.both(), spot = smoothstep(0.5, 0.2, crystal.nearest);
  c = c * (1 + 0.3 * look_.grains * which * which * which * spot);
  // Edges are rubbed pale; soot stays in hollows.
  const double rubbed = smoothstep(0.2, 0.55, round) * smoothstep(0.98, 0.6, round);
  c = mix(c, c * 1.16 + rgb(0x0a0908), 0.5 * rubbed * spec_.wear);
  const double soot = smoothstep(0.02, -0.16, relief.height) * (0.25 + 0.6 * spec_.wear);
  p.color = mix(c, c * 0.66, soot);
  p.roughness = 0.8 + 0.1 * relief.fine - 0.06 * rubbed + 0.06 * soot;
  return p;
}

SurfacePoint StoneFace::mortar_at(double u, double v, double d) const {
  const double coarse = canvas_.fbm(u, v, 6 / unit_, 4, 0.6, sand);
  const double fine = canvas_.fbm(u, v, 34 / unit_, 4, 0.8, sand + 32);
  const double meniscus = smoothstep(-0.3 * look_.joint, 0.0, d);
  const CellPoint grain = canvas_.cells(u, v, 50 / unit_, sand + 64);
  Dice kind(grain.bits);
  const double shade = kind.both() * smoothstep(0.6, 0.2, grain.nearest);
  SurfacePoint p;
  p.height = 0.78 - look_.hollow + 0.04 * meniscus + 0.06 * coarse + 0.07 * fine + 0.02 * shade;
  p.color = palette_.joint * (0.94 + 0.24 * coarse + 0.22 * fine + 0.16 * shade);
  p.roughness = 0.92 + 0.07 * fine;
  return p;
}

SurfacePoint StoneFace::weathered(double u, double v, SurfacePoint p, double low) const {
  const double wet = smoothstep(0.0, 0.5, canvas_.fbm(u, v, 2.5, 6, 0.58, damp));
  p.color = mix(p.color, saturated(p.color, 0.9) * 0.7, 0.65 * spec_.wear * wet);
  p.roughness += 0.04 * wet * spec_.wear;
  // Moss and lichen, more of it where water stays.
  const double patch = canvas_.fbm(u, v, 0.9 / unit_, 6, 0.62, lichen) + 0.16 * low;
  const double grown = smoothstep(0.2, 0.42, patch + 0.25 * (spec_.wear - 0.5)) * spec_.wear;
  p.color = mix(p.color, palette_.stain * (0.9 + 0.5 * patch), 0.6 * grown);
  p.roughness = mix(p.roughness, 0.96, grown);
  return p;
}

}  // namespace terrazzo
