#pragma once

#include <vector>

#include "core/material/variants.h"

namespace terrazzo {

/// Several exemplars side by side in one material, so that whatever works on one exemplar works on all of them:
/// analysis, index, uv map and resolve stay as they are. Immutable; thread-safe.
struct Atlas {
  MaterialPtr material;  ///< lazily computed
  ImagePtr mask;         ///< 1 where an exemplar may be sampled, 0 in gaps; of the material's size
  ImagePtr labels;       ///< which exemplar: i / (n - 1) for the i-th of n (0 if there is one), in gaps the nearest's
  std::vector<Rect> places;  ///< where each exemplar lies, in pixels of the material
};

/// Lays exemplars out on shelves, the tallest first, `gap` pixels or a few more apart. Every pixel of a placed map is
/// one of its exemplar's, unchanged; gaps are filled with what lies beyond the exemplar's border. A map that is smaller
/// than its material by the same whole factor in all exemplars (or by multiples of it) is smaller in the atlas by that
/// factor; maps of other sizes are sampled at the nearest pixel. Maps are described as the first exemplar's are: other
/// exemplars' are converted to its colour space and normal convention.
///
/// Throws Error about "materials" if exemplars differ in their maps, their meaning or channels, or if the atlas would
/// be larger than 65536 pixels a side.
Atlas make_atlas(const std::vector<Exemplar>& exemplars, int gap, Outside outside);

}  // namespace terrazzo
