#pragma once

#include <filesystem>
#include <memory>

#include "core/image_io/image_libraries.h"

namespace terrazzo {

/// A decoder for PNG files that needs only libpng: own code since OpenImageIO takes ten times as long to load as a
/// cached run takes. As with image_libraries(), palettes and low depths are expanded, transparent colours become alpha,
/// and values are returned as stored, regardless of gamma or profile.
/// Null if the file is no PNG, or has EXIF data that may hold an orientation: use image_libraries() for those. Throws
/// Error with libpng's reason if the header is damaged.
std::unique_ptr<ImageDecoder> open_png(const std::filesystem::path& path);

/// An encoder for PNG files that needs only libpng. The same pixels give the same bytes.
std::unique_ptr<ImageEncoder> create_png(const EncodedImage& image, ByteSink& sink);

}  // namespace terrazzo
