#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/image/image.h"

/// Image files, through OpenImageIO. All functions are thread-safe and throw Error with the path, what was expected and
/// what was found.
namespace terrazzo {

/// The formats that can be written.
enum class FileFormat : uint8_t {
  png,
  tiff,
  exr,
  jpeg,
  tga,
  tx  ///< a TIFF file of tiles and mip levels, as renderers' texture systems take it (OpenImageIO's maketx)
};

/// What a file says of itself without its pixels being read.
struct FileInfo {
  Size size;
  int channels = 0;
  Depth depth = Depth::u8;
  std::string description{};  ///< of PNG, TIFF and EXR files, as write_image stores it
  std::string layer{};        ///< see read_layer_infos
  std::string color_space{};  ///< "lin_rec709" if a PNG file's gAMA chunk says that its values are linear; else empty
  int orientation = 1;        ///< its tag, as in EXIF; `size` is that of the upright image
  std::vector<std::string> channel_names{};  ///< as the file has them; may be empty
};

/// Whether the name ends like an image file that can be read.
bool looks_like_image(const std::filesystem::path& path);

/// Throws unless there is a file that may be read; what is in it is not looked at.
void require_image_file(const std::filesystem::path& path);

/// Throws for what reading the file would fail at, as far as this shows in little time, before anything is decoded:
/// there is no such file, what it takes to read it is not installed, or its end is missing.
void require_readable_image(const std::filesystem::path& path);

/// `layer` as in read_image.
FileInfo read_image_info(const std::filesystem::path& path, const std::string& layer = "");

/// The layers of an EXR file: its parts, and the channels of one prefix in them ("normal" of normal.X, normal.Y and
/// normal.Z). Channels without a prefix are the layer "". Other files are one layer "".
std::vector<FileInfo> read_layer_infos(const std::filesystem::path& path);

/// Reads the first image of the file into memory, or the EXR layer of that name; case does not count. Without a name a
/// file's only layer is meant, or that of channels without a prefix. 1..4 channels come through; palettes are expanded;
/// CMYK, Lab and images of more channels are refused, as are EXR files whose data window leaves a part of the display
/// window without data, integers of 32 bits that seem to be ids, empty, truncated and absurdly large files (over 2^31
/// pixel values). Colours come as they are without alpha: they are divided by it where the file says that they are
/// multiplied. Alpha of colours that is 0 everywhere becomes 1. An EXR file comes as its display window, told if that
/// is not its data window, an image with an orientation tag as it is meant to be seen. Values of 8 bits are exactly k /
/// 255, of 16 bits k / 65535; halfs stay halfs; integers of other depths become floats. Single pixels that are not
/// finite take the mean of their neighbours; many are refused. Normals stored as signed numbers are encoded. `warn` is
/// told whatever the user should know, a sentence each, beginning with warning_mark if it is about values that are
/// lost. `info` gives semantic, colour space and normal convention; size, channels and depth are taken from the file.
/// `as_stored`: an orientation tag is ignored.
ImagePtr read_image(const std::filesystem::path& path, const ImageInfo& info,
                    const std::function<void(const std::string&)>& warn, const std::string& layer = "",
                    bool as_stored = false);

struct WriteOptions {
  FileFormat format = FileFormat::png;
  Depth depth = Depth::u8;  ///< must be one the format can hold, see `holds`
  int jpeg_quality = 95;
  std::string description{};       ///< stored in the file if not empty
  std::vector<ImagePtr> levels{};  ///< the mip levels below the image, for tx
};
std::string_view name_of(FileFormat format);
bool holds(FileFormat format, Depth depth);
/// From the name's extension; nullopt if it is none of the formats that can be written.
std::optional<FileFormat> format_from(const std::filesystem::path& path);

/// Values outside 0..1 that an integer depth cannot hold.
struct Clipping {
  int64_t values = 0;         ///< how many
  int64_t all = 0;            ///< of how many
  float least = 0, most = 0;  ///< those that were clipped
};

/// Writes strip by strip, pulling the image's pixels as it goes; `progress` is called with the fraction done and may
/// throw to stop. No dithering: a value read from a file of the same depth is written back exactly. The same pixels
/// give the same bytes. JPEG has no alpha channel and leaves it out. Throws FileError where the operating system
/// refuses (no space, no permission), Error where the format does; the file is then incomplete and the caller's to
/// remove.
Clipping write_image(const Image& image, const std::filesystem::path& path, const WriteOptions& options,
                     const std::function<void(double)>& progress);

/// The image as a file in memory, an 8-bit PNG unless `options` say otherwise; else as write_image.
std::vector<uint8_t> encoded_file(const Image& image, const WriteOptions& options = {});

}  // namespace terrazzo
