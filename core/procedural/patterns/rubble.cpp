#include <algorithm>

#include "core/procedural/pattern_types.h"
#include "core/procedural/stone_face.h"
#include "core/procedural/stone_packing.h"

namespace terrazzo {

namespace {

/// A wall of uncoursed random rubble: rounded stones of very different sizes in mortar.
class Rubble : public Surface {
 public:
  enum Salt : uint64_t { stones = 1, stone = 32, warp_u, warp_v };

  Rubble(const Canvas& canvas, const PatternSpec& spec, const Palette& palette)
      : canvas_(canvas),
        unit_(1 / visible_scale(spec)),
        bend_(unit_ * (0.05 + 0.09 * spec.irregularity)),
        packing_(canvas, {unit_, radii(spec.irregularity), stones}),
        face_(canvas, spec, palette,
              {.joint = 0.11, .rounding = 0.3, .edge = 0.035, .hollow = 0.5, .rough = 0.24, .facets = 0.6}, unit_) {}

  SurfacePoint at(double u, double v) const override {
    const auto [wu, wv] = bent(u, v);
    const StonePacking::Place p = packing_.at(wu, wv);
    return face_.at(u, v, {p.x, p.y, p.distance, lattice_bits(canvas_.seed() ^ stone, int64_t(p.id), 0)});
  }

  uint64_t element(double u, double v) const override {
    const auto [wu, wv] = bent(u, v);
    return packing_.owner(wu, wv).id;
  }

 private:
  struct Point {
    double u, v;
  };
  Point bent(double u, double v) const {
    return {u + bend_ * canvas_.fbm(u, v, 1.5 / unit_, 3, 0.5, warp_u),
            v + bend_ * canvas_.fbm(u, v, 1.5 / unit_, 3, 0.5, warp_v)};
  }

  /// From stones of nearly one size to large ones with small ones between them.
  static std::vector<double> radii(double irregularity) {
    const double s = std::min(1.0, 1.4 * irregularity);
    return {0.46 + 0.42 * s, 0.46 + 0.18 * s, 0.46 - 0.02 * s, 0.46 - 0.13 * s, 0.46 - 0.2 * s};
  }

  Canvas canvas_;
  double unit_;  ///< the mean size of a stone
  double bend_;
  StonePacking packing_;
  StoneFace face_;
};

}  // namespace

PatternType rubble_pattern() {
  PatternType t;
  t.name = "rubble";
  t.summary = "a wall of uncoursed rubble: stones of very different sizes in mortar";
  t.scale = 6;
  t.depth = 0.2;
  t.cavity = 0.45;
  t.palettes = {
      {"limestone",
       {rgb(0xa59a85), rgb(0xb3a992), rgb(0x958b79), rgb(0xa89a80), rgb(0x8c8577)},
       rgb(0xb0a590),
       rgb(0x565a36)},
      {"fieldstone",
       {rgb(0x7c746a), rgb(0x8f7f6c), rgb(0x68686a), rgb(0x86705e), rgb(0x767a7a)},
       rgb(0x9c9383),
       rgb(0x4c5530)},
      {"slate", {rgb(0x55595e), rgb(0x656668), rgb(0x484d54), rgb(0x6a635c)}, rgb(0x8e8a82), rgb(0x6c6f4c)},
  };
  t.make = make_surface<Rubble>;
  return t;
}

}  // namespace terrazzo
