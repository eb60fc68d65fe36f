#pragma once

#include "core/exemplar/uv_map.h"
#include "core/image/float_planes.h"

namespace terrazzo {

/// Figures about a result, computed from its uv map.
struct LayoutFigures {
  double seam_share = 0;       ///< share of pairs of neighbours that are not neighbours in the exemplar, 0..1
  double seam_difference = 0;  ///< mean appearance difference across those seams, in standard deviations; 0 if none
  double seam_energy = 0;      ///< their product: appearance difference per pair of neighbours
  double usage_entropy = 0;    ///< entropy of exemplar use in 16x16 cells over its maximum: 1 = even use
  double verbatim = 0;         ///< typical side of a copied region as a fraction of the exemplar's side
  double largest_copy = 0;     ///< area of the largest copied region as a fraction of the exemplar's area
};

/// `exemplar`: its channels in comparable units, resampled to the analysed size if needed. The difference across a seam
/// is the cost of graph cuts (Kwatra et al. 2003): each side's continuation against the actual pixel. `wraps`: the
/// exemplar tiles, so that crossing its border is not a seam.
LayoutFigures layout_figures(const UvMap& layout, const Planes& exemplar, bool wraps);

}  // namespace terrazzo
