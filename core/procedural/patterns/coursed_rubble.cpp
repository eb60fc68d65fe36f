#include <cmath>

#include "core/procedural/block_courses.h"
#include "core/procedural/pattern_types.h"
#include "core/procedural/stone_face.h"

namespace terrazzo {

namespace {

/// A wall of roughly dressed stones of all lengths, in courses of all heights.
class CoursedRubble : public Surface {
 public:
  enum Salt : uint64_t { courses = 1, stone = 32, warp_u, warp_v };

  CoursedRubble(const Canvas& canvas, const PatternSpec& spec, const Palette& palette)
      : canvas_(canvas),
        irregularity_(spec.irregularity),
        length_(1 / visible_scale(spec)),
        unit_(length_ * 0.56),
        courses_(canvas,
                 {.length = length_,
                  .height = unit_,
                  .height_spread = 0.65 * spec.irregularity,
                  .length_spread = 0.2 + 0.6 * spec.irregularity},
                 courses),
        face_(canvas, spec, palette,
              {.joint = 0.13,
               .rounding = 0.22,
               .edge = 0.04,
               .hollow = 0.42,
               .rough = 0.26,
               .facets = 0.55,
               .riven = 0.15},
              unit_) {}

  SurfacePoint at(double u, double v) const override {
    const BlockCourses::Place p = place(u, v);
    const uint64_t bits = lattice_bits(canvas_.seed() ^ stone, int64_t(p.block->id), 0);
    return face_.at(u, v, {p.x, p.y, distance(p, Dice(bits + 1)), bits});
  }

  uint64_t element(double u, double v) const override { return place(u, v).block->id; }

 private:
  BlockCourses::Place place(double u, double v) const {
    const double bend = unit_ * 0.22 * irregularity_;
    return courses_.at(u + bend * canvas_.fbm(u, v, 0.8 / unit_, 3, 0.5, warp_u),
                       v + bend * canvas_.fbm(u, v, 0.8 / unit_, 3, 0.5, warp_v));
  }

  /// The distance to the sides of a roughly dressed block: they slant, and the corners are cut off.
  double distance(const BlockCourses::Place& p, Dice dice) const {
    const double half_width = (p.block->right - p.block->left) / 2, half_height = (p.block->bottom - p.block->top) / 2;
    const double slant = 0.09 * irregularity_;
    const double top = slant * dice.both(), bottom = slant * dice.both();
    const double left = slant * dice.both(), right = slant * dice.both();
    const double x = p.x / half_width, y = p.y / half_height;
    const double narrow = unit_ * (x < 0 ? left : right) * y, low = unit_ * (y < 0 ? top : bottom) * x;
    const double rounding =
        std::min(unit_ * (0.16 + 0.2 * irregularity_ * dice.unit()), 0.9 * std::min(half_width, half_height));
    return -rounded_box(p.x, p.y, half_width, half_height, rounding) - std::abs(x) * std::max(0.0, narrow) -
           std::abs(y) * std::max(0.0, low);
  }

  Canvas canvas_;
  double irregularity_;
  double length_;  ///< the mean length of a stone
  double unit_;    ///< the mean height of a course
  BlockCourses courses_;
  StoneFace face_;
};

}  // namespace

PatternType coursed_rubble_pattern() {
  PatternType t;
  t.name = "coursed_rubble";
  t.summary = "a wall of roughly dressed stones in courses of differing heights";
  t.scale = 4;
  t.depth = 0.12;
  t.cavity = 0.45;
  t.palettes = {
      {"cotswold",
       {rgb(0xb39a6c), rgb(0xc0a97d), rgb(0xa58c62), rgb(0xb09e7e), rgb(0x998567)},
       rgb(0xa99b80),
       rgb(0x54552f)},
      {"gritstone", {rgb(0x7d7466), rgb(0x8d8271), rgb(0x6c655c), rgb(0x84745f)}, rgb(0x99907f), rgb(0x474d2c)},
      {"lava", {rgb(0x56514e), rgb(0x665e59), rgb(0x494749), rgb(0x6b574c)}, rgb(0x8f877b), rgb(0x63653f)},
  };
  t.make = make_surface<CoursedRubble>;
  return t;
}

}  // namespace terrazzo
