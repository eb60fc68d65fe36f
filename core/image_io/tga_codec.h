#pragma once

#include <filesystem>
#include <memory>

#include "core/image_io/image_libraries.h"

namespace terrazzo {

/// A decoder for TGA files of 16 bits a pixel, five a colour and one of alpha, which the image library drops. Null for
/// other files, and where the header says that the sixteenth bit is unused. Throws Error if the file is cut off.
std::unique_ptr<ImageDecoder> open_tga_with_alpha_bit(const std::filesystem::path& path);

}  // namespace terrazzo
