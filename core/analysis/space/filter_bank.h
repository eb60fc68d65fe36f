#pragma once

#include <array>
#include <vector>

#include "core/analysis/space/planes.h"

namespace terrazzo {

/// The responses of the MR8 filter bank, interleaved per pixel, row by row.
struct FilterResponses {
  std::vector<float> edges;  ///< three, finest scale first: how strong an edge there is, whichever way it runs
  std::vector<float> bars;   ///< three, finest scale first: positive on light lines, negative on dark ones
  std::vector<float> blobs;  ///< two: lighter than the surroundings (Gaussian), the same but sharper (Laplacian)
};

/// The maximum response filter bank (Varma & Zisserman, A statistical approach to texture classification from single
/// images, 2005): 38 filters, 8 responses. Edges and bars are the first and second derivative across, times a Gaussian
/// three times as long along, at 6 orientations and deviations of 1, 2 and 4 pixels times `scale`, of which the
/// response of greatest size counts, whatever the orientation; blobs are a Gaussian and its Laplacian of 10 pixels
/// times `scale`. Filters are 49 pixels a side times `scale`, have zero mean and an L1 norm of 1: responses are at most
/// the image's range. Second derivatives are negated, so that light is positive.
///
/// `image`: one channel; beyond its border it wraps or continues, as it says. By FFT, block by block. The same bits on
/// every machine and for any number of threads. `scale` is in [0.25, 4]. Throws Cancelled.
FilterResponses mr8_responses(const Planes& image, double scale, const Task& task);

}  // namespace terrazzo
