#pragma once

#include <filesystem>
#include <memory>

#include "core/image_io/image_libraries.h"

namespace terrazzo {

/// A decoder for 16-bit TGA files, with five bits per colour and one of alpha, own code since the image library drops
/// it. Null for other files, and if the header declares the alpha bit unused. Throws Error if the file is truncated.
std::unique_ptr<ImageDecoder> open_tga_with_alpha_bit(const std::filesystem::path& path);

}  // namespace terrazzo
