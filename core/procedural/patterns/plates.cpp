#include <cmath>

#include "core/base/portable_math.h"
#include "core/procedural/block_courses.h"
#include "core/procedural/pattern_types.h"
#include "core/procedural/stone_face.h"

namespace terrazzo {

namespace {

using namespace portable;

/// Riveted steel plates in bands of several heights.
class Plates : public Surface {
 public:
  enum Salt : uint64_t { bands = 1, plate = 32, tone, grain, brushed, rust, drip, dent };

  Plates(const Canvas& canvas, const PatternSpec& spec, const Palette& palette)
      : canvas_(canvas),
        spec_(spec),
        palette_(palette),
        length_(1 / visible_scale(spec)),
        unit_(length_ * 0.6),
        bands_(canvas,
               {.length = length_,
                .height = unit_,
                .heights = {1, 1.5, 0.65},
                .length_spread = 0.6 * spec.irregularity,
                .tall_share = 0.3 * spec.irregularity},
               bands) {}

  SurfacePoint at(double u, double v) const override {
    const BlockCourses::Place p = bands_.at(u, v);
    const double half_width = (p.block->right - p.block->left) / 2, half_height = (p.block->bottom - p.block->top) / 2;
    Dice dice(lattice_bits(canvas_.seed() ^ plate, int64_t(p.block->id), 0));
    const Rgb base = pick_color(palette_.pieces, dice);
    const double shade = 1 + 0.1 * dice.both(), lift = dice.both(), lean = dice.both();
    const double d = -rounded_box(p.x, p.y, half_width, half_height, 0.05 * unit_) / unit_;
    const double fine = canvas_.fbm(u, v, 40 / unit_, 3, 0.6, grain);
    const double clouds = canvas_.fbm(u, v, 1.2 / unit_, 5, 0.55, tone);
    const double dented = canvas_.fbm(u, v, 0.9 / unit_, 2, 0.5, dent);
    const double far = from_rivet(p, half_width, half_height);
    const double rivet = far < 1 ? std::sqrt(1 - far * far) : 0;
    const double eaten =
        smoothstep(0.1, 0.5, canvas_.fbm(u, v, 1.4 / unit_, 7, 0.62, rust) + 0.25 * (0.12 - d) / 0.12) * spec_.wear;

    SurfacePoint s;
    const double edge = smoothstep(0.008, 0.03, d);
    s.height = 0.62 * edge + spec_.irregularity * (0.04 * lift + 0.05 * lean * p.x / half_width) + 0.03 * dented +
               0.008 * fine + 0.3 * rivet;
    Rgb c = base * (shade + 0.12 * clouds + 0.05 * fine);
    c = mix(c, c * 1.25 + rgb(0x0a0a0a), 0.5 * smoothstep(0.06, 0.03, d) * edge);
    // Dirt gathers around rivets, and their tops are rubbed bright.
    c = mix(c, c * 0.55, smoothstep(1.5, 1.0, far) * (1 - rivet));
    c = mix(c, c * 1.3 + rgb(0x060606), 0.5 * rivet);
    c = mix(c, palette_.stain * (0.9 + 0.3 * fine), 0.75 * eaten);
    s.color = mix(palette_.joint, c, edge);
    s.roughness = mix(0.9, mix(0.38 + 0.08 * fine + 0.08 * clouds, 0.85, eaten), edge);
    return s;
  }

  uint64_t element(double u, double v) const override { return bands_.at(u, v).block->id; }

 private:
  /// How far the nearest rivet is, in its radii. They sit in the corners and, along long sides, between them.
  double from_rivet(const BlockCourses::Place& p, double half_width, double half_height) const {
    const double inset = 0.14 * unit_, radius = 0.055 * unit_;
    const double reach_x = half_width - inset, reach_y = half_height - inset;
    if (reach_x <= 0 || reach_y <= 0) return 100;
    const double gaps = std::max(1.0, std::floor(2 * reach_x / (0.8 * unit_))), apart = 2 * reach_x / gaps;
    const double x = p.x + reach_x, nearest = apart * std::floor(x / apart + 0.5);
    const double dx = x - std::min(std::max(nearest, 0.0), 2 * reach_x), dy = std::abs(p.y) - reach_y;
    return std::sqrt(dx * dx + dy * dy) / radius;
  }

  Canvas canvas_;
  PatternSpec spec_;
  Palette palette_;
  double length_;  ///< the mean length of a plate
  double unit_;    ///< the mean height of a band
  BlockCourses bands_;
};

}  // namespace

PatternType plates_pattern() {
  PatternType t;
  t.name = "plates";
  t.summary = "riveted steel plates in bands of several heights";
  t.scale = 3;
  t.depth = 0.03;
  t.cavity = 0.4;
  t.palettes = {
      {"steel", {rgb(0x70747a), rgb(0x7c7f83), rgb(0x666a70)}, rgb(0x1c1d1f), rgb(0x6b3f22)},
      {"painted", {rgb(0x4d5c44), rgb(0x566549), rgb(0x46533f)}, rgb(0x181a16), rgb(0x70452a)},
      {"copper", {rgb(0x9a6a4c), rgb(0xa87656), rgb(0x8b5c41)}, rgb(0x241812), rgb(0x4f8a76)},
  };
  t.make = make_surface<Plates>;
  return t;
}

}  // namespace terrazzo
