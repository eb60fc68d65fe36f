#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/image_io/file_pixels.h"
#include "core/image_io/format_facts.h"
#include "core/image_io/image_libraries.h"

/// Opens and validates image files, for core/image_io/image_file.h. Thread-safe for different OpenFiles.
namespace terrazzo {

/// An open file with a valid header.
struct OpenFile {
  std::unique_ptr<ImageDecoder> in;
  FormatFacts facts{};
  bool as_stored = false;  ///< the orientation tag is ignored

  const StoredImage& header() const { return in->header(); }
  int channels() const { return int(header().channels.size()); }
  /// The layout of its values when kept in this depth.
  PixelLayout layout(Depth depth) const { return {depth, header().stored, header().size, orientation(), channels()}; }
  int orientation() const { return as_stored ? 1 : header().orientation; }
  bool is_turned() const { return layout({}).is_turned(); }
  Size upright() const { return layout({}).upright(); }
};

/// Opens a file, or one of its layers, that must hold a flat image of 1 to 4 channels within the limits
/// (core/image/image_limits.h). Throws Error with the path.
OpenFile open_image_file(const std::filesystem::path& path, const std::string& layer);

/// Throws Error if the file is truncated or damaged in ways that the image library does not notice.
void require_complete(const std::filesystem::path& path, const OpenFile& file);

/// Throws Error "cannot read <path>: <reason>".
[[noreturn]] void fail_to_read(const std::filesystem::path& path, const std::string& reason);

/// "albedo", "normal"; without the layer of channels that have no prefix.
std::string listed_layers(const std::vector<std::string>& layers);

/// "32x16 at (-4, 2)".
std::string described_window(const Rect& window);

/// Turns the library's error message into a single-line clause.
std::string one_line(std::string text);

}  // namespace terrazzo
