#include "core/procedural/block_courses.h"
#include "core/procedural/pattern_types.h"
#include "core/procedural/stone_face.h"

namespace terrazzo {

namespace {

/// A wall of squared stones in courses of several heights, with thin joints and some stones two courses high.
class Ashlar : public Surface {
 public:
  enum Salt : uint64_t { courses = 1, stone = 32 };

  Ashlar(const Canvas& canvas, const PatternSpec& spec, const Palette& palette)
      : canvas_(canvas),
        length_(1 / visible_scale(spec)),
        unit_(length_ * 0.55),
        loose_(unit_ * 0.012 * spec.irregularity),
        courses_(canvas,
                 {.length = length_,
                  .height = unit_,
                  .heights = {1, 1.35, 0.72},
                  .length_spread = 0.55 * spec.irregularity,
                  .tall_share = 0.7 * spec.irregularity},
                 courses),
        face_(canvas, spec, palette,
              {.joint = 0.05, .rounding = 0.05, .edge = 0.010, .hollow = 0.34, .rough = 0.11, .tooled = 0.5}, unit_) {}

  SurfacePoint at(double u, double v) const override {
    const BlockCourses::Place p = courses_.at(u, v);
    const uint64_t bits = lattice_bits(canvas_.seed() ^ stone, int64_t(p.block->id), 0);
    Dice dice(bits + 1);
    const double half_width = (p.block->right - p.block->left) / 2, half_height = (p.block->bottom - p.block->top) / 2;
    const double d = -rounded_box(p.x + loose_ * dice.both(), p.y + loose_ * dice.both(), half_width, half_height,
                                  std::min(unit_ * 0.04, half_height));
    return face_.at(u, v, {p.x, p.y, d, bits});
  }

  uint64_t element(double u, double v) const override { return courses_.at(u, v).block->id; }

 private:
  Canvas canvas_;
  double length_;  ///< the mean length of a stone
  double unit_;    ///< the mean height of a course
  double loose_;
  BlockCourses courses_;
  StoneFace face_;
};

}  // namespace

PatternType ashlar_pattern() {
  PatternType t;
  t.name = "ashlar";
  t.summary = "squared stones in courses of several heights, some two courses high";
  t.scale = 4;
  t.depth = 0.08;
  t.cavity = 0.35;
  t.palettes = {
      {"sandstone",
       {rgb(0xb59b73), rgb(0xc0a880), rgb(0xa88c66), rgb(0xb8a283), rgb(0xab9478)},
       rgb(0xb3a78f),
       rgb(0x54532f)},
      {"limestone", {rgb(0xb9b09c), rgb(0xc3baa6), rgb(0xaca48f), rgb(0xb5ab9a)}, rgb(0xbdb5a3), rgb(0x5b5c40)},
      {"granite", {rgb(0x85837f), rgb(0x939089), rgb(0x757678), rgb(0x8a8079)}, rgb(0x9d978c), rgb(0x50562f)},
  };
  t.make = make_surface<Ashlar>;
  return t;
}

}  // namespace terrazzo
