#pragma once

#include <array>
#include <vector>

#include "core/analysis/space/planes.h"

namespace terrazzo {

/// The responses of the MR8 filter bank, interleaved per pixel, row by row.
struct FilterResponses {
  std::vector<float> edges;  ///< three, finest scale first: edge strength in any direction
  std::vector<float> bars;   ///< three, finest scale first: positive on light lines, negative on dark lines
  std::vector<float> blobs;  ///< two: lighter than the surroundings (Gaussian), the same but sharper (Laplacian)
};

/// The maximum response filter bank (Varma & Zisserman, A statistical approach to texture classification from single
/// images, 2005): 38 filters, 8 responses. Edges and bars are first and second derivatives of anisotropic Gaussians
/// (ratio 3, sigma 1, 2 and 4 pixels times `scale`), the strongest of 6 orientations; blobs are a Gaussian and its
/// Laplacian (sigma 10 times `scale`). Filters are 49 pixels a side times `scale`, with zero mean and an L1 norm of 1:
/// responses are at most the image's range. Second derivatives are negated, so that light is positive.
///
/// `image`: one channel; wraps or clamps as it says. `scale`: 0.25..4. The same bits on every machine and for any
/// number of threads. Throws Cancelled.
FilterResponses mr8_responses(const Planes& image, double scale, const Task& task);

}  // namespace terrazzo
