#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/image/image.h"

/// Per-pixel operations on images, computed when pulled. Thread-safe.
namespace terrazzo {

/// The image resampled to another size by nearest neighbour, computed when pulled. Keeps maps of different sizes
/// aligned.
ImagePtr nearest_at_size(const ImagePtr& image, Size size);

/// Computes `count` pixels from the corresponding pixels of each input.
using PixelFunction = std::function<void(std::span<const float* const> inputs, float* out, int64_t count)>;

/// An image whose pixels depend only on the corresponding pixels of the inputs, computed when pulled. All inputs must
/// have size info.size; `recipe` as for Image::computed.
ImagePtr pixel_by_pixel(ImageInfo info, const Digest& recipe, std::vector<ImagePtr> inputs, PixelFunction function);

}  // namespace terrazzo
