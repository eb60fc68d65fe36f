#pragma once

#include "core/base/task.h"
#include "core/image/float_planes.h"

namespace terrazzo {

/// The sliced Wasserstein-1 distance (Rabin et al. 2011) between the 7x7 patch distributions of two images with the
/// same channels, each slice in units of the exemplar's standard deviation. 0 = the same patches in the same
/// proportions. Windows of an exemplar that wraps go on around its border, here and below. Throws Cancelled.
double sliced_wasserstein(const Planes& exemplar, const Planes& output, const Task& task);

/// Bidirectional patch similarity (Simakov et al. 2008), in units of the mean distance between exemplar patches: of
/// each to the nearest that is at least `step` pixels away in one direction.
struct PatchSimilarity {
  double coherence = 0;     ///< mean distance of an output patch to its nearest exemplar patch
  double completeness = 0;  ///< mean distance of an exemplar patch to its nearest output patch
  double broken = 0;        ///< share of output patches farther from the exemplar than 95 % of its own patches
};
/// `step`: of the samples of a patch; images smoothed for a reduction by it are compared as if they were reduced, but
/// at all pixels. Throws Cancelled.
PatchSimilarity patch_similarity(const Planes& exemplar, const Planes& output, int step, const Task& task);

}  // namespace terrazzo
