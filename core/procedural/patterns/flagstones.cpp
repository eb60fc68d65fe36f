#include <cmath>

#include "core/base/portable_math.h"
#include "core/procedural/block_courses.h"
#include "core/procedural/pattern_types.h"
#include "core/procedural/stone_face.h"

namespace terrazzo {

namespace {

using namespace portable;

/// Flagstones of many sizes with grass growing between them and over their edges.
class Flagstones : public Surface {
 public:
  enum Salt : uint64_t { courses = 1, stone = 32, sward = 40, blades, clumps };

  Flagstones(const Canvas& canvas, const PatternSpec& spec, const Palette& palette)
      : canvas_(canvas),
        spec_(spec),
        palette_(palette),
        length_(1 / visible_scale(spec)),
        unit_(length_ * 0.8),
        courses_(canvas,
                 {.length = length_,
                  .height = unit_,
                  .heights = {1, 1.3, 0.75},
                  .length_spread = 0.6 * spec.irregularity,
                  .tall_share = 0.6 * spec.irregularity},
                 courses),
        face_(canvas, spec, palette,
              {.joint = 0.12, .rounding = 0.12, .edge = 0.03, .hollow = 0.3, .rough = 0.14, .riven = 0.5}, unit_) {}

  SurfacePoint at(double u, double v) const override {
    const BlockCourses::Place p = courses_.at(u, v);
    const uint64_t bits = lattice_bits(canvas_.seed() ^ stone, int64_t(p.block->id), 0);
    const double half_width = (p.block->right - p.block->left) / 2, half_height = (p.block->bottom - p.block->top) / 2;
    const double d = -rounded_box(p.x, p.y, half_width, half_height, std::min(unit_ * 0.12, half_height));
    const SurfacePoint ground = face_.at(u, v, {p.x, p.y, d, bits});

    // Grass fills the joints and spreads over edges where it grows well.
    const double well = canvas_.fbm(u, v, 1.3 / unit_, 3, 0.5, sward);
    const double tuft = canvas_.fbm(u, v, 9 / unit_, 4, 0.65, clumps);
    const double reach = 0.075 + 0.06 * (0.4 + spec_.wear) * well + 0.035 * tuft;
    const double grown = smoothstep(0.02, -0.015, d / unit_ - reach);
    if (grown <= 0) return ground;
    const double blade = canvas_.fbm(u, v, 34 / unit_, 3, 0.7, blades);
    SurfacePoint s;
    s.height = mix(ground.height, std::max(ground.height, 0.34 + 0.2 * tuft + 0.22 * blade), grown);
    s.color = mix(ground.color, palette_.stain * (0.85 + 0.5 * blade + 0.25 * tuft), grown);
    s.roughness = mix(ground.roughness, 0.95, grown);
    return s;
  }

  uint64_t element(double u, double v) const override { return courses_.at(u, v).block->id; }

 private:
  Canvas canvas_;
  PatternSpec spec_;
  Palette palette_;
  double length_;  ///< the mean length of a stone
  double unit_;    ///< the mean height of a course
  BlockCourses courses_;
  StoneFace face_;
};

}  // namespace

PatternType flagstones_pattern() {
  PatternType t;
  t.name = "flagstones";
  t.summary = "flagstones of many sizes with grass growing between them";
  t.scale = 3.5;
  t.depth = 0.09;
  t.cavity = 0.35;
  t.palettes = {
      {"limestone", {rgb(0xa39b88), rgb(0xaea692), rgb(0x968e7c)}, rgb(0x574d3a), rgb(0x55682f)},
      {"slate", {rgb(0x5d6267), rgb(0x686d71), rgb(0x53585e)}, rgb(0x3b352b), rgb(0x4d6133)},
      {"sandstone", {rgb(0xad9069), rgb(0xb79a74), rgb(0xa0855f)}, rgb(0x5a4a33), rgb(0x66702f)},
  };
  t.make = make_surface<Flagstones>;
  return t;
}

}  // namespace terrazzo
