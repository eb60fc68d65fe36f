#pragma once

#include <filesystem>
#include <memory>

#include "core/image_io/image_libraries.h"

namespace terrazzo {

/// A decoder for the composite of Photoshop files (PSD, PSB) of the modes grey, indexed and RGB, of 8, 16 and 32 bits:
/// the image library drops their alpha channel and misreads palettes. The first channel after the colours is alpha;
/// where it is the transparency of layers, which Photoshop blends onto white, the colours are parted from the white
/// again. Null for other files. Throws Error if the file is damaged or cut off.
std::unique_ptr<ImageDecoder> open_psd(const std::filesystem::path& path);

}  // namespace terrazzo
