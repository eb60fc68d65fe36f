#pragma once

#include <vector>

#include "core/image/image.h"

/// Mip chains: an image at half its size, a quarter and so on, down to one pixel.
namespace terrazzo {

/// The image followed by all its mip levels. Each level has half the sides of the previous one, rounded down but at
/// least 1. Its pixels average the covered area, wrapping around at the edges: colours in linear light, normals as
/// vectors that are renormalised, other maps as stored. Labels and masks are sampled. Levels are computed from
/// unrounded values. `weights` (see opacity_weights) weight colours; in the smaller levels, fully transparent pixels
/// take the colour of the nearest visible ones, since renderers blend them with their neighbours. Computes all pixels,
/// into memory or a scratch file. Throws Cancelled by the current task. Thread-safe.
std::vector<ImagePtr> mip_levels(const ImagePtr& image, const ImagePtr& weights = nullptr);

/// The number of levels of an image of this size, including itself.
int mip_level_count(Size size);

}  // namespace terrazzo
