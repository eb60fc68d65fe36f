#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/image_io/file_pixels.h"
#include "core/image_io/format_facts.h"
#include "core/image_io/image_libraries.h"

/// What reading an image file (core/image_io/image_file.h) begins with. Thread-safe for different OpenFiles.
namespace terrazzo {

/// An open file whose header has been found good.
struct OpenFile {
  std::unique_ptr<ImageDecoder> in;
  FormatFacts facts{};
  bool as_stored = false;  ///< the orientation tag is ignored

  const StoredImage& header() const { return in->header(); }
  int channels() const { return int(header().channels.size()); }
  /// Of its values, kept in such a depth.
  PixelLayout layout(Depth depth) const { return {depth, header().stored, header().size, orientation(), channels()}; }
  int orientation() const { return as_stored ? 1 : header().orientation; }
  bool is_turned() const { return layout({}).is_turned(); }
  Size upright() const { return layout({}).upright(); }
};

/// Opens a file, or a layer of it, that holds a flat picture of 1 to 4 channels within the limits
/// (core/image/image_limits.h). Throws Error with the path.
OpenFile open_image_file(const std::filesystem::path& path, const std::string& layer);

/// Throws Error if the file is cut off or damaged, which the image library does not notice.
void require_complete(const std::filesystem::path& path, const OpenFile& file);

/// Throws Error "cannot read <path>: <reason>".
[[noreturn]] void fail_to_read(const std::filesystem::path& path, const std::string& reason);

/// "albedo", "normal"; the one of channels without a prefix is not shown.
std::string listed_layers(const std::vector<std::string>& layers);

/// "32x16 at (-4, 2)".
std::string described_window(const Rect& window);

/// The library's reason as a part of a sentence.
std::string one_line(std::string text);

}  // namespace terrazzo
