#include <cmath>

#include "core/base/portable_math.h"
#include "core/procedural/pattern_types.h"

namespace terrazzo {

namespace {

using namespace portable;

/// One yarn at a point.
struct Strand {
  double height = 0;
  double rim = 2;    ///< distance from the yarn's middle in half widths; above 1: beside the yarn
  double twist = 0;  ///< -1..1: valley to ridge of the twisted plies
  double fibre = 0;  ///< -1..1: single fibres
  double lift = 0;   ///< -1..1: under or over the crossing yarn
  Rgb color;
};

/// Cloth in plain weave: yarns of twisted fibres that go over and under each other.
class Weave : public Surface {
 public:
  enum Salt : uint64_t { warp_yarn = 1, weft_yarn, sway_u, sway_v, slub_u, slub_v, fibre, fuzz, shade, lint };

  Weave(const Canvas& canvas, const PatternSpec& spec, const Palette& palette)
      : canvas_(canvas),
        spec_(spec),
        palette_(palette),
        grid_(canvas, even(spec.scale, canvas.wraps()), 1, 2),
        columns_(1 / grid_.cell_width()),
        rows_(canvas.aspect() / grid_.cell_height()) {}

  SurfacePoint at(double u, double v) const override {
    const double sway = (0.04 + 0.16 * spec_.irregularity);
    const double x = u * columns_ + sway * canvas_.fbm(u, v, columns_ * 0.22, 4, 0.6, sway_u);
    const double y = v / grid_.cell_height() + sway * canvas_.fbm(u, v, columns_ * 0.22, 4, 0.6, sway_v);
    const int64_t column = floor_int(x), row = floor_int(y);
    // Wefts run across, warps run down; where one is over, the other is under.
    const double weft_lift = cos_turns(0.5 * (x - 0.5 + double(row)));
    const double warp_lift = -cos_turns(0.5 * (y - 0.5 + double(column)));
    const int across = canvas_.wraps() ? int(columns_ + 0.5) : 0, down = canvas_.wraps() ? int(rows_ + 0.5) : 0;
    const Strand weft = strand(u, v, x, y - double(row) - 0.5, weft_lift, grid_.bits(0, row, weft_yarn), across, true);
    const Strand warp =
        strand(u, v, y, x - double(column) - 0.5, warp_lift, grid_.bits(column, 0, warp_yarn), down, false);
    const Strand& over = weft.height > warp.height ? weft : warp;
    const Strand& under = weft.height > warp.height ? warp : weft;
    return lit(u, v, over, under);
  }

 private:
  static double even(double count, bool wraps) {
    return wraps ? 2 * std::max(1.0, double(floor_int(count / 2 + 0.5))) : count;
  }

  /// `along` the yarn and `side` of its middle, in cells; `length`: cells until it repeats, 0: never.
  Strand strand(double u, double v, double along, double side, double lift, uint64_t bits, int length,
                bool is_weft) const {
    Dice dice(bits);
    Strand s;
    s.lift = lift;
    const double thick = dice.both(), tone = dice.both(), turn = dice.unit(), drift = dice.both();
    const double slub = canvas_.fbm(u, v, columns_ * 0.5, 3, 0.5, is_weft ? slub_u : slub_v);
    // Yarns are squeezed where they dive under, and spread on top.
    const double half = 0.43 + 0.04 * lift + (0.07 * thick + 0.14 * slub) * (0.3 + 0.7 * spec_.irregularity);
    const double t = (side - 0.05 * drift * spec_.irregularity) / half;
    s.rim = std::abs(t);
    if (s.rim >= 1) {
      s.height = -1;
      return s;
    }
    const double round = std::sqrt(1 - t * t);
    // Plies wind around the yarn: on its round face they slant and bunch up towards the sides.
    const double slant = t * (1 + 0.25 * t * t);
    const double phase = along * plies - 1.15 * slant * (is_weft ? 1 : -1) + turn;
    const double ridge = std::abs(cos_turns(phase * 0.5));
    s.twist = 1 - 2 * (1 - ridge) * (1 - ridge);
    const Period period{length * int(plies) * 5, 0};
    const double hair = gradient_noise(phase * 5, slant * 2.2 + turn * 50, bits, period);
    const Period fine_period{length * int(plies) * 11, 0};
    const double fine = gradient_noise(phase * 11, slant * 3.1 + turn * 90, bits + 1, fine_period);
    s.fibre = 0.6 * hair + 0.5 * fine;
    s.height = 0.42 + 0.2 * lift + 0.26 * round + round * (0.055 * s.twist + 0.05 * s.fibre);
    const std::vector<Rgb>& colors = palette_.pieces;
    const Rgb base = is_weft ? colors[1] : colors[0];
    s.color = base * (1 + 0.15 * tone + 0.16 * slub);
    return s;
  }

  SurfacePoint lit(double u, double v, const Strand& s, const Strand& under) const {
    const double fine = canvas_.fbm(u, v, columns_ * 7, 4, 0.7, fibre);
    const double worn = canvas_.fbm(u, v, 3, 5, 0.6, shade);
    SurfacePoint p;
    if (s.height < 0) {
      p.height = 0.12 + 0.05 * fine;
      p.color = palette_.joint * (0.8 + 0.4 * fine);
      p.roughness = 0.95;
      return p;
    }
    p.height = s.height + 0.025 * fine;
    const double depth = smoothstep(-0.7, 0.9, s.lift);
    Rgb c = s.color * ((0.72 + 0.28 * depth) * (1 + 0.13 * s.twist + 0.26 * s.fibre + 0.16 * fine));
    c = mix(c, palette_.joint, 0.55 * smoothstep(0.55, 1.0, s.rim) * smoothstep(-0.3, -1.2, under.height));
    c = mix(c, c * 0.7, 0.45 * smoothstep(0.7, 1.0, s.rim));
    // Rubbing pales the crowns; stains come in broad patches.
    c = mix(c, c * 0.8 + palette_.stain * 0.28, spec_.wear * 0.55 * smoothstep(-0.1, 0.5, worn) * depth);
    // Loose fibres lie across the yarns.
    const double wisp = std::abs(canvas_.fbm(u, v, columns_ * 0.7, 3, 0.45, fuzz));
    const double present = smoothstep(0.1, 0.35, canvas_.noise(u, v, columns_ * 0.45, lint));
    const double loose = present * smoothstep(0.016, 0.004, wisp) * (0.3 + 0.5 * spec_.wear);
    p.height += 0.05 * loose;
    p.color = mix(c, c * 0.6 + palette_.stain * 0.45, 0.7 * loose);
    p.roughness = 0.82 + 0.08 * s.fibre - 0.05 * s.twist + 0.06 * (1 - depth);
    return p;
  }

  static constexpr double plies = 3;  ///< turns of the plies per crossing

  Canvas canvas_;
  PatternSpec spec_;
  Palette palette_;
  Grid grid_;
  double columns_;
  double rows_;
};

}  // namespace

PatternType weave_pattern() {
  PatternType t;
  t.name = "weave";
  t.summary = "cloth in plain weave of twisted yarns";
  t.scale = 20;
  t.depth = 0.55;
  t.cavity = 0.55;
  t.palettes = {
      {"linen", {rgb(0xb8a585), rgb(0xc2b294)}, rgb(0x4a4031), rgb(0xd9cfba)},
      {"denim", {rgb(0x3a4f74), rgb(0x8f9bb0)}, rgb(0x1a2234), rgb(0xb9c2cf)},
      {"madder", {rgb(0x8e3a30), rgb(0xa0503c)}, rgb(0x331512), rgb(0xc99a84)},
      {"jute", {rgb(0x94713f), rgb(0xa07c48)}, rgb(0x2d2112), rgb(0xc7aa76)},
  };
  t.make = make_surface<Weave>;
  return t;
}

}  // namespace terrazzo
