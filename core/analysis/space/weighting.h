#pragma once

#include "core/base/number_map.h"
#include "core/exemplar/features.h"
#include "core/material/material.h"

namespace terrazzo {

/// A map as analysis sees it: colours in Oklab, normals as unit vectors with y up, everything else as it is. Lazy.
ImagePtr analysis_image(const ImagePtr& map);

/// Weight of a map if none is given; 0 for maps that repeat others or carry no structure.
double default_weight(Semantic semantic);

/// The weighted channels of a material. `weights`: per map one number, or one per channel in analysis space; others get
/// `default_weight`. Maps smaller than the largest are resampled to its size. `wraps`: the exemplar tiles. `mask`: the
/// exemplar may be sampled where its first channel exceeds 0.5; same aspect ratio, any size; null: everywhere. Throws
/// Error about "weights" if the material lacks a map.
FeaturesPtr weighted_features(const Material& material, const NumberMap& weights, bool wraps,
                              const ImagePtr& mask = nullptr);

/// Weights for the maps chosen for an analysis: 1 for each of `maps`, 0 for others; without `maps` the defaults, or 1
/// for all if those are all 0. Throws Error about "maps" if the material lacks one.
NumberMap weights_of_chosen(const Material& material, const std::vector<std::string>& maps);

}  // namespace terrazzo
