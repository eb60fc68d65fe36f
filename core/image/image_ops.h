#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/image/image_facts.h"

/// What operations on images share: checks whose messages say what was found, and images computed pixel by pixel when
/// they are pulled. Thread-safe.
namespace terrazzo {

/// For images that are there: what core/image/image_facts.h says and checks.
inline std::string describe(const Image& image) {
  return describe(facts_of(image.info()));
}
inline void require_one_channel(const std::string& port, const Image& image) {
  require_one_channel(port, facts_of(image.info()));
}
inline void require_shape(const std::string& port, const Image& image, const std::string& of, Size size) {
  require_shape(port, facts_of(image.info()), of, size);
}

/// The image at another size by nearest samples: keeps maps of different sizes aligned. Computed when pulled.
ImagePtr nearest_at_size(const ImagePtr& image, Size size);

/// Makes `count` pixels out of the same pixels of each input.
using PixelFunction = std::function<void(std::span<const float* const> inputs, float* out, int64_t count)>;

/// An image whose every pixel depends on the same pixel of each input, computed when pulled. All inputs have info.size;
/// `recipe` as for Image::computed.
ImagePtr pixel_by_pixel(ImageInfo info, const Digest& recipe, std::vector<ImagePtr> inputs, PixelFunction function);

}  // namespace terrazzo
