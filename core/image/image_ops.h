#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/image/image.h"

/// What operations on images share: images computed pixel by pixel when they are pulled. Thread-safe.
namespace terrazzo {

/// The image at another size by nearest samples: keeps maps of different sizes aligned. Computed when pulled.
ImagePtr nearest_at_size(const ImagePtr& image, Size size);

/// Makes `count` pixels out of the same pixels of each input.
using PixelFunction = std::function<void(std::span<const float* const> inputs, float* out, int64_t count)>;

/// An image whose every pixel depends on the same pixel of each input, computed when pulled. All inputs have info.size;
/// `recipe` as for Image::computed.
ImagePtr pixel_by_pixel(ImageInfo info, const Digest& recipe, std::vector<ImagePtr> inputs, PixelFunction function);

}  // namespace terrazzo
