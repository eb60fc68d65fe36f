#pragma once

#include <vector>

#include "core/image/image.h"

/// Mip chains: an image at half its size, a quarter, and so on down to one pixel.
namespace terrazzo {

/// The image and all levels below it. Each has half the sides of the one above, rounded down but at least 1, and its
/// pixels are averages of what they cover there, around the edges as if the image repeated: in linear light for
/// colours, as vectors that are made unit length again for normals, and as stored for other maps; of labels and masks
/// they are samples. Levels are made from unrounded values of the one above. `weights`, of `opacity_weights`, says how
/// much colours count; below the image itself, pixels of which nothing is seen then take the colour of what is seen
/// nearest to them, since renderers blend it with their neighbours'. All pixels lie in memory or in a scratch file
/// afterwards. Throws Cancelled with the task that the thread works for. Thread-safe.
std::vector<ImagePtr> mip_levels(const ImagePtr& image, const ImagePtr& weights = nullptr);

/// How many levels an image of that size has, itself included.
int mip_level_count(Size size);

}  // namespace terrazzo
