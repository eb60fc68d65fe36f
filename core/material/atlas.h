#pragma once

#include <vector>

#include "core/material/variants.h"

namespace terrazzo {

/// Several exemplars side by side in one material, which analysis, index, uv map and resolve treat as a single
/// exemplar. Immutable; thread-safe.
struct Atlas {
  MaterialPtr material;  ///< lazily computed
  ImagePtr mask;         ///< 1 where an exemplar may be sampled, 0 in gaps; of the material's size
  ImagePtr labels;       ///< exemplar number: i / (n - 1) for the i-th of n (0 if there is one), in gaps the nearest's
  std::vector<Rect> places;  ///< where each exemplar lies, in pixels of the material
};

/// Packs exemplars on shelves, tallest first, at least `gap` pixels apart. Pixels do not change; `outside` says what
/// fills the gaps. A map smaller than its material by the same whole factor in all exemplars (or by multiples of it) is
/// smaller in the atlas by that factor; maps of other sizes are sampled at the nearest pixel. Maps are converted to the
/// first exemplar's colour space and normal convention.
///
/// Throws Error about "materials" if exemplars differ in their maps, or these in semantic or channels, or if the atlas
/// would exceed 65536 pixels a side.
Atlas make_atlas(const std::vector<Exemplar>& exemplars, int gap, Outside outside);

}  // namespace terrazzo
