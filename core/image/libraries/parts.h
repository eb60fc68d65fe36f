#pragma once

#include "core/image/image_libraries.h"

/// The functions of the module, one for each member of ImageLibraries.
namespace terrazzo {

std::unique_ptr<ImageDecoder> open_with_oiio(const std::string& path);
std::unique_ptr<ImageEncoder> create_with_oiio(const std::string& name, const EncodedImage& image, ByteSink* sink);
std::shared_ptr<const ColorConfiguration> load_with_ocio(const std::string& path);

}  // namespace terrazzo
