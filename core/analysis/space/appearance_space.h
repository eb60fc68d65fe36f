#pragma once

#include <vector>

#include "core/base/task.h"
#include "core/exemplar/appearance.h"
#include "core/exemplar/features.h"

namespace terrazzo {

struct AppearanceOptions {
  int dimensions = appearance_dimensions;  ///< at most, per level
  double retained_variance = 1;            ///< keep only as many dimensions as explain this fraction
  double guidance_weight = 0.25;           ///< at the coarsest level; fades linearly to 0 at the finest
};

/// Throws Error if an exemplar of that size is too small or too large to be analysed.
void require_analysable(Size exemplar);
/// How many levels its appearance has.
int appearance_levels(Size exemplar);

/// Transforms an exemplar into appearance space (Lefebvre & Hoppe, Appearance-space texture synthesis, 2006): per level
/// of a Gaussian pyramid, Gaussian-weighted 5x5 neighbourhoods of all weighted channels are projected on their
/// principal components. `guidance`: images of the features' size, any number of channels, that steer coarse levels.
/// Throws Error about sizes, and Cancelled.
AppearancePtr make_appearance(const Features& features, const std::vector<ImagePtr>& guidance,
                              const AppearanceOptions& options, const Task& task);

}  // namespace terrazzo
