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
  tx  ///< a tiled, mip-mapped TIFF file for renderers' texture systems (OpenImageIO's maketx)
};

/// What a file's header says.
struct FileInfo {
  Size size;
  int channels = 0;
  Depth depth = Depth::u8;
  std::string description{};  ///< of PNG, TIFF and EXR files, as write_image stores it
  std::string layer{};        ///< see read_layer_infos
  std::string color_space{};  ///< "lin_rec709" if a PNG file's gAMA chunk says that its values are linear; else empty
  int orientation = 1;        ///< EXIF orientation tag; `size` is that of the upright image
  std::vector<std::string> channel_names{};  ///< as in the file; may be empty
};

/// Whether the name has the extension of a readable image format.
bool looks_like_image(const std::filesystem::path& path);

/// Throws unless the file exists and may be read. Does not look at its content.
void require_image_file(const std::filesystem::path& path);

/// A quick check that decodes nothing. Throws if the file does not exist, if a library needed to read it is not
/// installed, or if the file is truncated.
void require_readable_image(const std::filesystem::path& path);

/// `layer` as in read_image.
FileInfo read_image_info(const std::filesystem::path& path, const std::string& layer = "");

/// The layers of an EXR file: its parts, and within a part the channels with a common prefix ("normal" of normal.X,
/// normal.Y and normal.Z). Channels without a prefix form the layer "". Other files have one layer, "".
std::vector<FileInfo> read_layer_infos(const std::filesystem::path& path);

/// Reads the first image of the file, or the EXR layer `layer` (case-insensitive). An empty name selects the only
/// layer, or the channels without a prefix. Accepts 1..4 channels and expands palettes. Throws for CMYK, Lab, more
/// channels, EXR files whose data window does not cover the display window, 32-bit integers that look like ids, and
/// empty, truncated or oversized files (over 2^31 pixel values). Colours are unpremultiplied if the file says they are
/// premultiplied. If a colour image's alpha is 0 everywhere it becomes 1. EXR files are cropped to their display
/// window, with a warning if it differs from the data window. The orientation tag is applied unless `as_stored`. 8-bit
/// values become exactly k / 255, 16-bit values k / 65535; halfs stay halfs; integers of other depths become floats.
/// Isolated non-finite pixels get the mean of their neighbours; many are an error. Signed normals are encoded. `info`
/// gives semantic, colour space and normal convention; size, channels and depth come from the file. `warn` gets notes
/// for the user, one sentence each; those about lost values begin with warning_mark.
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
/// From the name's extension; nullopt if the format cannot be written.
std::optional<FileFormat> format_from(const std::filesystem::path& path);

/// Values outside 0..1, which integer depths cannot hold.
struct Clipping {
  int64_t values = 0;         ///< number of clipped values
  int64_t all = 0;            ///< number of all values
  float least = 0, most = 0;  ///< range of the clipped values
};

/// Writes strip by strip, pulling the image's pixels on the way. Calls `progress` with the fraction done; it may throw
/// to stop. No dithering: a value read from a file of the same depth is written back exactly. The same pixels give the
/// same bytes. Drops alpha for JPEG. Throws FileError on operating system errors (no space, no permission), Error on
/// format errors; the caller must then remove the incomplete file.
Clipping write_image(const Image& image, const std::filesystem::path& path, const WriteOptions& options,
                     const std::function<void(double)>& progress);

/// Encodes the image as a file in memory, by default an 8-bit PNG. Throws as write_image.
std::vector<uint8_t> encoded_file(const Image& image, const WriteOptions& options = {});

}  // namespace terrazzo
