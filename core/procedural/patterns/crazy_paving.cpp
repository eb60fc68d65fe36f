#include "core/procedural/pattern_types.h"
#include "core/procedural/slab_cuts.h"
#include "core/procedural/stone_face.h"

namespace terrazzo {

namespace {

/// Paving of broken flat slabs, with joints of even width.
class CrazyPaving : public Surface {
 public:
  enum Salt : uint64_t { slabs = 1, slab = 64, warp_u, warp_v };

  CrazyPaving(const Canvas& canvas, const PatternSpec& spec, const Palette& palette)
      : canvas_(canvas),
        unit_(1 / visible_scale(spec)),
        bend_(unit_ * 0.05 * spec.irregularity),
        slabs_(canvas, unit_, spec.irregularity, slabs),
        face_(canvas, spec, palette,
              {.joint = 0.06,
               .rounding = 0.035,
               .edge = 0.012,
               .hollow = 0.3,
               .rough = 0.12,
               .riven = 0.8,
               .grains = 0.7},
              unit_) {}

  SurfacePoint at(double u, double v) const override {
    const SlabCuts::Place p = place(u, v);
    return face_.at(u, v, {p.x, p.y, p.distance, lattice_bits(canvas_.seed() ^ slab, int64_t(p.id), 0)});
  }

  uint64_t element(double u, double v) const override { return place(u, v).id; }

 private:
  SlabCuts::Place place(double u, double v) const {
    return slabs_.at(u + bend_ * canvas_.fbm(u, v, 1.6 / unit_, 3, 0.5, warp_u),
                     v + bend_ * canvas_.fbm(u, v, 1.6 / unit_, 3, 0.5, warp_v));
  }

  Canvas canvas_;
  double unit_;  ///< the mean size of a slab
  double bend_;
  SlabCuts slabs_;
  StoneFace face_;
};

}  // namespace

PatternType crazy_paving_pattern() {
  PatternType t;
  t.name = "crazy_paving";
  t.summary = "paving of broken flat slabs with even joints";
  t.scale = 5;
  t.depth = 0.11;
  t.cavity = 0.4;
  t.palettes = {
      {"sandstone",
       {rgb(0xa8916f), rgb(0xb49c7c), rgb(0x998266), rgb(0xa58a74), rgb(0x8f8470)},
       rgb(0x8b8070),
       rgb(0x55582f)},
      {"bluestone", {rgb(0x626a70), rgb(0x70767a), rgb(0x555d66), rgb(0x6d6a68)}, rgb(0x8d8a84), rgb(0x4d5638)},
      {"quartzite",
       {rgb(0x9a9086), rgb(0xa9977f), rgb(0x8a8a88), rgb(0x9c7f6c), rgb(0x7f8482)},
       rgb(0xa39c90),
       rgb(0x55572f)},
  };
  t.make = make_surface<CrazyPaving>;
  return t;
}

}  // namespace terrazzo
