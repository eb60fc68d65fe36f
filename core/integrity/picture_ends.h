#pragma once

#include <filesystem>

/// Whether image files go on to their ends, told from sizes and tables in them, without decoding anything.
namespace terrazzo {

/// False if the end of an EXR, BMP, TGA, WebP, GIF or Radiance file is missing; true for files of other formats, and
/// where the structure does not say it (deep EXR files).
bool is_untruncated(const std::filesystem::path& path);

}  // namespace terrazzo
