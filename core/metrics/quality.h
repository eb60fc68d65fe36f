#pragma once

#include <string>
#include <vector>

#include "core/base/task.h"
#include "core/image/float_planes.h"
#include "core/material/material.h"

namespace terrazzo {

/// How well an output reproduces its exemplar's texture, from pixels alone and without learned weights. Dimensionless;
/// lower is better. Read them together: plain tiling wins all but verbatim and repeat.
struct QualityFigures {
  double swd = 0;           ///< see sliced_wasserstein; mean over a Gaussian pyramid
  double cooccurrence = 0;  ///< see cooccurrence_distance; mean over up to 3 levels
  double coherence = 0;     ///< see PatchSimilarity; mean over up to 3 levels
  double completeness = 0;
  double broken = 0;
  double structure = 0;  ///< see foreign_structure; in windows of a third to a half of an element
  double acf = 0;        ///< see autocorrelation_difference
  double verbatim = 0;   ///< see verbatim_copies; at half size
  double repeat = 0;     ///< see repetition
};

/// Pixels a side of the smallest image that can be measured.
inline constexpr int smallest_measured = 16;
/// Pixels a side; of larger images only the top left part is measured.
inline constexpr int largest_measured = 2048;

/// What to measure, and what is known of the exemplar.
struct QualityParts {
  bool verbatim = true;  ///< not needed with a uv map; stays 0 then
  double element = 0;    ///< side of its typical element in pixels; 0: four times its correlation_length
  bool wraps = false;    ///< it tiles
};

/// Both images have the same channels and at least smallest_measured pixels a side. Deterministic. Thread-safe; throws
/// Cancelled.
QualityFigures measure_quality(Planes exemplar, Planes output, const QualityParts& parts, const Task& task);

/// The channels of the exemplar's and the output's maps, stacked, in units of the exemplar's standard deviation.
/// Colours and vectors give three channels, other maps their first; grey becomes three channels if the other image has
/// colour. At most largest_measured pixels a side, from the top left.
struct ComparedPlanes {
  Planes exemplar;
  Planes output;
};
/// `maps`: names; empty for all that both have. Throws Error about "maps" if one lacks a map, or two maps of one name
/// are not comparable.
ComparedPlanes compared_planes(const Material& exemplar, const Material& output, const std::vector<std::string>& maps);

/// `maps`, checked, or all maps that both have, in the exemplar's order. Throws Error about "maps".
std::vector<std::string> compared_maps(const Material& exemplar, const Material& output,
                                       const std::vector<std::string>& maps);

}  // namespace terrazzo
