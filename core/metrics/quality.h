#pragma once

#include <string>
#include <vector>

#include "core/base/task.h"
#include "core/image/float_planes.h"
#include "core/material/material.h"

namespace terrazzo {

/// How well an output reproduces its exemplar's texture, measured on pixels without learned weights. Dimensionless;
/// lower is better. Read them together: plain tiling wins in all but verbatim and repeat.
struct QualityFigures {
  double swd = 0;           ///< see sliced_wasserstein; mean over a Gaussian pyramid
  double cooccurrence = 0;  ///< see cooccurrence_distance; mean over up to 3 levels
  double coherence = 0;     ///< see PatchSimilarity; mean over up to 3 scales, at all pixels
  double completeness = 0;
  double broken = 0;
  double structure = 0;  ///< see foreign_structure; in windows of a third to a half of an element
  double acf = 0;        ///< see autocorrelation_difference
  double verbatim = 0;   ///< see verbatim_copies; at half size
  double repeat = 0;     ///< see repetition
};

/// The smallest side, in pixels, of an image that can be measured.
inline constexpr int smallest_measured = 16;
/// In pixels; of images with longer sides only the top left part is measured.
inline constexpr int largest_measured = 2048;

/// What to measure, and known facts about the exemplar.
struct QualityParts {
  bool verbatim = true;  ///< measure `verbatim`; unnecessary with a uv map
  double element = 0;    ///< side of its typical element in pixels; 0: four times its correlation_length
};

/// Both images have the same channels and at least smallest_measured pixels a side. Of an exemplar that wraps, patches
/// and structure are also looked for across its border. Deterministic. Thread-safe; throws
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

/// The validated `maps`, or, if empty, all common maps in the exemplar's order. Throws Error about "maps".
std::vector<std::string> compared_maps(const Material& exemplar, const Material& output,
                                       const std::vector<std::string>& maps);

}  // namespace terrazzo
