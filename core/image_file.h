#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "core/image.h"

/// Image files, through OpenImageIO. All functions are thread-safe and throw Error with the path, what was expected and
/// what was found.
namespace terrazzo {

/// The formats that can be written.
enum class FileFormat : uint8_t { png, tiff, exr, jpeg };

/// What a file says of itself without its pixels being read.
struct FileInfo {
  Size size;
  int channels = 0;
  Depth depth = Depth::u8;
  std::string color_space;  ///< as the file declares it, else empty
};

/// Whether the name ends like an image file that can be read.
bool looks_like_image(const std::filesystem::path& path);

FileInfo read_image_info(const std::filesystem::path& path);

/// Reads the first image of the file into memory. 1..4 channels come through; palettes are expanded, CMYK and images of
/// more channels are refused, as are empty, truncated and absurdly large files (over 2^31 pixel values).
/// Pixels that are not finite become 0, and `warn` is told how many. `info` gives semantic, colour space and normal
/// convention; size, channels and depth are taken from the file.
ImagePtr read_image(const std::filesystem::path& path, const ImageInfo& info,
                    const std::function<void(const std::string&)>& warn);

struct WriteOptions {
  FileFormat format = FileFormat::png;
  Depth depth = Depth::u8;  ///< must be one the format can hold, see `holds`
  int jpeg_quality = 95;
};
bool holds(FileFormat format, Depth depth);
/// From the name's extension; nullopt if it is none of the formats that can be written.
std::optional<FileFormat> format_from(const std::filesystem::path& path);

/// Writes strip by strip, pulling the image's pixels as it goes; `progress` is called with the fraction done and may
/// throw to stop. No dithering: a value read from a file of the same depth is written back exactly.
void write_image(const Image& image, const std::filesystem::path& path, const WriteOptions& options,
                 const std::function<void(double)>& progress);

}  // namespace terrazzo
