#pragma once

#include <filesystem>
#include <memory>

#include "core/image_io/image_libraries.h"

namespace terrazzo {

/// A decoder for the composite image of Photoshop files (PSD, PSB) in grey, indexed and RGB mode with 8, 16 and 32
/// bits: own code since the image library drops their alpha channel and misreads palettes. The first channel after the
/// colours is alpha. If it is the transparency of the merged layers, which Photoshop blends onto white, the white is
/// removed from the colours. Null for other files. Throws Error if the file is damaged or truncated.
std::unique_ptr<ImageDecoder> open_psd(const std::filesystem::path& path);

}  // namespace terrazzo
