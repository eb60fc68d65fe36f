#pragma once

#include <vector>

#include "core/material/variants.h"

namespace terrazzo {

/// Several exemplars packed side by side into one material, which analysis, index, uv map and resolve treat as a single
/// exemplar. Immutable; thread-safe.
struct Atlas {
  MaterialPtr material;  ///< computed when pulled
  ImagePtr mask;         ///< 1 where an exemplar may be sampled, 0 in gaps; of the material's size
  ImagePtr labels;       ///< i / (n - 1) for the i-th of n exemplars (0 if n is 1); gaps have the label of the nearest
  std::vector<Rect> places;  ///< the rectangle of each exemplar, in pixels of the material
};

/// Packs exemplars on shelves, tallest first, at least `gap` pixels apart. Pixels do not change; `outside` says what
/// fills the gaps. If a map is smaller than its material by a common integer factor in all exemplars (or by multiples
/// of it), it is smaller in the atlas by that factor; maps of other sizes are resampled by nearest neighbour. Maps are
/// converted to the first exemplar's colour space and normal convention.
///
/// Throws Error about "materials" if the exemplars' maps differ in name, semantic or channels, or if the atlas would
/// exceed 65536 pixels a side.
Atlas make_atlas(const std::vector<Exemplar>& exemplars, int gap, Outside outside);

}  // namespace terrazzo
