#pragma once

#include <string>
#include <vector>

#include "core/base/task.h"
#include "core/image/float_planes.h"
#include "core/material/material.h"

namespace terrazzo {

/// How well an output shows the texture of its exemplar, from pixels alone and without learned weights. All are lower
/// is better and dimensionless. Read them together: plain tiling wins all but verbatim and repeat.
struct Quality {
  double swd = 0;           ///< see sliced_wasserstein; mean over a Gaussian pyramid
  double cooccurrence = 0;  ///< see cooccurrence_distance; mean over up to 3 levels
  double coherence = 0;     ///< see PatchSimilarity; mean over up to 3 levels
  double completeness = 0;
  double broken = 0;
  double acf = 0;       ///< see autocorrelation_difference
  double verbatim = 0;  ///< see verbatim_copies; at half size
  double repeat = 0;    ///< see repetition
};

/// The smallest image that can be measured, in pixels a side.
inline constexpr int smallest_measured = 16;
/// Of larger images the part at the top left is measured.
inline constexpr int largest_measured = 2048;

/// What to measure; the rest stays 0.
struct QualityParts {
  bool verbatim = true;  ///< not needed if a uv map tells it
};

/// Both images have the same channels and at least smallest_measured pixels a side. Deterministic. Thread-safe; throws
/// Cancelled.
Quality measure_quality(Planes exemplar, Planes output, const QualityParts& parts, const Task& task);

/// The channels of the exemplar's and the output's maps, stacked, in units of the exemplar's standard deviation.
/// Colours and vectors give three channels, other maps their first;
/// grey counts as three equal channels where the other image has colour. At most largest_measured pixels a side, from
/// the top left.
struct ComparedPlanes {
  Planes exemplar;
  Planes output;
};
/// `maps`: names that both have; empty for all they share. Throws Error (about "maps") if one has no such map, or if
/// two maps of one name do not fit together.
ComparedPlanes compared_planes(const Material& exemplar, const Material& output, const std::vector<std::string>& maps);

/// `maps`, checked, or all maps that both have, in the exemplar's order.
std::vector<std::string> compared_maps(const Material& exemplar, const Material& output,
                                       const std::vector<std::string>& maps);

}  // namespace terrazzo
