#pragma once

#include <filesystem>
#include <memory>

#include "core/image_io/image_libraries.h"

namespace terrazzo {

/// A decoder for PNG files that needs nothing but libpng, which is loaded quickly. Palettes and low depths are
/// expanded, transparent colours become alpha, and values come as they are stored, whatever gamma or profile is named,
/// as with image_libraries(). Null if the file is no PNG, or has EXIF data that may say which side is up: those read
/// it. Throws Error with libpng's reason for a damaged header.
std::unique_ptr<ImageDecoder> open_png(const std::filesystem::path& path);

/// An encoder for PNG files, which needs nothing but libpng either. The same pixels give the same bytes.
std::unique_ptr<ImageEncoder> create_png(const EncodedImage& image, ByteSink& sink);

}  // namespace terrazzo
