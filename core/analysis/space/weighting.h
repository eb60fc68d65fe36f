#pragma once

#include "core/base/number_map.h"
#include "core/exemplar/features.h"
#include "core/material/material.h"

namespace terrazzo {

/// A map as analysis sees it: colours in Oklab, normals as unit vectors with y up, everything else as it is. Lazy.
ImagePtr analysis_image(const ImagePtr& map);

/// How much a map counts unless told otherwise; 0 for maps that only mirror others or say nothing of structure.
double default_weight(Semantic semantic);

/// The weighted channels of a material. `weights`: per map name one number, or one per channel of the map in analysis
/// space; maps not named get `default_weight`. Maps smaller than the largest are sampled at its size. `wraps`: the
/// exemplar tiles. `mask`: where its first channel exceeds 0.5 the exemplar may be sampled, at any size of the same
/// shape; null: everywhere. Throws Error naming the maps if a weight is for a map the material does not have.
FeaturesPtr weighted_features(const Material& material, const NumberMap& weights, bool wraps,
                              const ImagePtr& mask = nullptr);

/// Weights for the maps an analysis was told to look at: 1 for each of `maps` and 0 for the others; the defaults if
/// none is named, or 1 for all if those are all 0. Throws Error about "maps" if the material lacks one.
NumberMap weights_of_chosen(const Material& material, const std::vector<std::string>& maps);

}  // namespace terrazzo
