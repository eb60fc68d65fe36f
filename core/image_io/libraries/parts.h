#pragma once

#include "core/image_io/image_libraries.h"

/// The functions of the module, one for each member of ImageLibraries.
namespace terrazzo {

std::unique_ptr<ImageDecoder> open_with_oiio(const std::string& path);
std::unique_ptr<ImageEncoder> create_with_oiio(const std::string& name, const EncodedImage& image, ByteSink* sink);
/// Reads 8-bit RGBA as stored from a WebP file that is not animated.
void read_webp(const std::string& path, Size size, void* out);
std::shared_ptr<const ColorConfiguration> load_with_ocio(const std::string& path, const std::string& text);

}  // namespace terrazzo
