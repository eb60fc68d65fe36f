#pragma once

#include "core/exemplar/uv_map.h"
#include "core/image/float_planes.h"

namespace terrazzo {

/// What a uv map alone tells of a result.
struct LayoutFigures {
  double seam_share = 0;       ///< share of neighbouring output pixels that are not neighbours in the exemplar
  double seam_difference = 0;  ///< mean appearance difference across those seams, in standard deviations; 0 if none
  double seam_energy = 0;      ///< the two multiplied: appearance difference per pair of neighbours
  double usage_entropy = 0;    ///< entropy of exemplar use in 16 by 16 cells over the maximum: 1 = even use
  double verbatim = 0;         ///< typical side of a copied region as a fraction of the exemplar's side
  double largest_copy = 0;     ///< area of the largest copied region as a fraction of the exemplar's area
};

/// `exemplar`: its channels in comparable units, resampled to the uv map's exemplar if its size is another. The
/// difference across a seam is that of graph cuts (Kwatra et al. 2003): each side's own continuation against what is
/// there. `wraps`: the exemplar tiles, so that going over its edge is no seam.
LayoutFigures layout_figures(const UvMap& layout, const Planes& exemplar, bool wraps);

}  // namespace terrazzo
