#pragma once

#include <vector>

#include "core/base/task.h"
#include "core/exemplar/appearance.h"
#include "core/exemplar/features.h"

namespace terrazzo {

struct AppearanceOptions {
  int dimensions = appearance_dimensions;  ///< at most that; the kept dimensions per level
  double retained_variance = 1;            ///< keep only as many dimensions as explain this fraction
  double guidance_weight = 0.25;           ///< at the coarsest level; fades linearly to 0 at the finest
};

/// Brings an exemplar into appearance space (Lefebvre & Hoppe 2006): per level of a Gaussian pyramid, the 5x5
/// neighbourhoods of all weighted channels, weighted by a Gaussian, are projected on their leading principal
/// components. `guidance`: images of the features' size, one value or more per pixel, that steer coarse levels.
AppearancePtr make_appearance(const Features& features, const std::vector<ImagePtr>& guidance,
                              const AppearanceOptions& options, const Task& task);

/// The channels of a level's pixels, without what is around them, as far as appearance vectors tell: `channels` values
/// per pixel, row by row. Of all channels the first `most`.
struct PixelChannels {
  int channels = 0;
  std::vector<float> values;
};
PixelChannels pixel_channels(const AppearanceLevel& level, int most);

}  // namespace terrazzo
