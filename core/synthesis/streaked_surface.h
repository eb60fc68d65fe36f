#pragma once

#include <optional>

#include "core/exemplar/appearance.h"
#include "core/exemplar/uv_map.h"
#include "core/synthesis/state/field.h"
#include "core/synthesis/synthesis_options.h"

namespace terrazzo {

/// A surface whose streaks are synthesized shortened, as its index shows them, and then drawn out to their length.
/// Without streaks, the surface itself. What it is made from must outlive it.
class StreakedSurface {
 public:
  StreakedSurface(const Appearance& appearance, const SynthesisOptions& options);

  /// The options that synthesize the shortened surface.
  const SynthesisOptions& shortened() const { return streaks_.any() ? shortened_ : options_; }
  /// The part of the shortened surface that drawing out a region looks at.
  Rect shortened(const Rect& region) const;
  /// A region of the surface. `field`: the part of the shortened surface for it.
  Field stretched(Field field, const Rect& region) const;

 private:
  struct Axis;
  Axis along(const Rect& region) const;
  ExemplarPixel shortened(ExemplarPixel p) const;
  ExistingPixels shortened_kept() const;
  /// The exemplar pixel so far on along the streaks; nothing outside of an exemplar that does not tile.
  std::optional<ExemplarPixel> along_streak(const Axis& a, ExemplarPixel p, int by) const;
  /// The first of the pixels that a step of the shortened exemplar stands for.
  ExemplarPixel first_of(const Axis& a, ExemplarPixel step) const;
  /// How many pixels on a streak ends that would at the border of a step.
  int random_streak_end(const Axis& a, int along, int across) const;
  /// What goes on from a kept pixel less than a step away, as far as the lot says.
  std::optional<ExemplarPixel> beside_kept(const Axis& a, int x, int y) const;
  /// The same, or what is kept there itself.
  std::optional<ExemplarPixel> kept_at(const Axis& a, int x, int y, ExemplarPixel step) const;

  const SynthesisOptions& options_;
  Streaks streaks_;
  Size exemplar_;
  bool wraps_;  // the exemplar
  SynthesisOptions shortened_;
};

}  // namespace terrazzo
