#pragma once

#include <filesystem>

/// Detects truncated image files from their sizes and tables, without decoding.
namespace terrazzo {

/// False if the end of an EXR, BMP, TGA, WebP, GIF or Radiance file is missing. True for other formats, and if the
/// structure does not reveal the length (deep EXR files).
bool is_untruncated(const std::filesystem::path& path);

}  // namespace terrazzo
