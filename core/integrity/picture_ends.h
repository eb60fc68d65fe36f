#pragma once

#include <filesystem>

/// Detects truncated image files from their sizes and tables. Own code since the libraries notice truncation only while
/// they decode, and this is asked of every input before a run starts.
namespace terrazzo {

/// False if the end of an EXR, BMP, TGA, WebP, GIF or Radiance file is missing. True for other formats, and if the
/// structure does not reveal the length (deep EXR files).
bool is_untruncated(const std::filesystem::path& path);

}  // namespace terrazzo
