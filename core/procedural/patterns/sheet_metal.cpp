#include <cmath>

#include "core/base/portable_math.h"
#include "core/procedural/pattern_types.h"

namespace terrazzo {

namespace {

using namespace portable;

/// Smooth sheet metal whose tone changes slowly; `scale` is the number of clouds across.
class SheetMetal : public Surface {
 public:
  enum Salt : uint64_t { cloud = 1, tint, grain, dull, bow, pits };

  SheetMetal(const Canvas& canvas, const PatternSpec& spec, const Palette& palette)
      : canvas_(canvas), spec_(spec), palette_(palette) {}

  SurfacePoint at(double u, double v) const override {
    const double slow = canvas_.fbm(u, v, spec_.scale, 2, 0.3, cloud);
    const double warm = canvas_.fbm(u, v, 0.8 * spec_.scale, 2, 0.3, tint);
    const double fine = canvas_.fbm(u, v, 0.5 / canvas_.pixel(), 1, 0.5, grain);
    const double stained = smoothstep(0.0, 0.7, canvas_.fbm(u, v, 1.3 * spec_.scale, 3, 0.4, dull)) * spec_.wear;
    const double at = saturate(0.5 + 0.9 * warm) * double(palette_.pieces.size() - 1);
    const auto index = std::min(size_t(at), palette_.pieces.size() - 2);
    const Rgb base = mix(palette_.pieces[index], palette_.pieces[index + 1], at - double(index));
    // A few pits, where the metal is eaten.
    const CellPoint cell = canvas_.cells(u, v, 12 * spec_.scale, pits);
    const double pit = Dice(cell.bits).unit() < 0.02 + 0.05 * spec_.wear ? smoothstep(0.35, 0.15, cell.nearest) : 0;
    SurfacePoint s;
    s.height = 0.5 + 0.35 * canvas_.fbm(u, v, 0.7 * spec_.scale, 2, 0.3, bow) * (0.5 + spec_.irregularity) +
               0.004 * fine - 0.45 * pit;
    s.color = mix(base * (1 + 0.14 * slow), palette_.stain, 0.35 * stained) * (1 + 0.02 * fine) * (1 - 0.12 * pit);
    s.roughness = 0.32 + 0.08 * slow + 0.25 * stained + 0.01 * fine + 0.1 * pit;
    return s;
  }

 private:
  Canvas canvas_;
  PatternSpec spec_;
  Palette palette_;
};

}  // namespace

PatternType sheet_metal_pattern() {
  PatternType t;
  t.name = "sheet_metal";
  t.summary = "smooth sheet metal whose tone changes slowly, like stains and clouds; no elements";
  t.scale = 4;
  t.depth = 0.08;
  t.cavity = 0.1;
  t.palettes = {
      {"steel", {rgb(0x7d8287), rgb(0x868b90), rgb(0x8c8d8f)}, rgb(0x5a5d60), rgb(0x6a655c)},
      {"brass", {rgb(0x9c8350), rgb(0xa88e58), rgb(0xae9463)}, rgb(0x6b5a36), rgb(0x6f6245)},
      {"zinc", {rgb(0x9aa0a3), rgb(0xa5a9ab), rgb(0x9b9fa6)}, rgb(0x6e7275), rgb(0x7b7d7a)},
  };
  t.make = make_surface<SheetMetal>;
  return t;
}

}  // namespace terrazzo
