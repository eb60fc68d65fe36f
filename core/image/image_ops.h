#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/image/image.h"

/// What operations on images share: checks whose messages say what was found, and images computed pixel by pixel when
/// they are pulled. Thread-safe.
namespace terrazzo {

/// "a height map of 256x128 pixels and 1 channel"
std::string describe(const Image& image);

/// Throws Error about `port` unless the image has one channel.
void require_one_channel(const std::string& port, const Image& image);
/// Throws Error about `port` if the image holds normals, whose channels mean nothing by themselves.
void require_no_normals(const std::string& port, const Image& image);
/// Throws Error about `port` unless both images have the same size.
void require_same_size(const std::string& port, const Image& image, const std::string& other_port, const Image& other);

/// Throws Error about `port` unless the image has the same shape as what it belongs to, to a pixel.
void require_shape(const std::string& port, const Image& image, const std::string& of, Size size);

/// The image at another size by nearest samples: keeps maps of different sizes aligned. Computed when pulled.
ImagePtr nearest_at_size(const ImagePtr& image, Size size);

/// Makes `count` pixels out of the same pixels of each input.
using PixelFunction = std::function<void(std::span<const float* const> inputs, float* out, int64_t count)>;

/// An image whose every pixel depends on the same pixel of each input, computed when pulled. All inputs have info.size;
/// `recipe` as for Image::computed.
ImagePtr pixel_by_pixel(ImageInfo info, const Digest& recipe, std::vector<ImagePtr> inputs, PixelFunction function);

}  // namespace terrazzo
