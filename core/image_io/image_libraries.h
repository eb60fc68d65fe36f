#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/base/geometry.h"
#include "core/image/image.h"
#include "core/image_io/image_file.h"

/// An interface to OpenImageIO and OpenColorIO. The two depend on some 250 shared libraries; linking those at startup
/// takes ten times as long as a fully cached run. The code that uses them (core/image_io/libraries/) is therefore a
/// module that is loaded on first use. The module uses only headers of the rest of terrazzo. Every function throws
/// Error with the library's own reason.
namespace terrazzo {

/// The header of an image file.
struct StoredImage {
  std::string format;           ///< the library's name for it: "png", "jpeg", "tiff", "openexr", ...
  Rect stored;                  ///< the pixels that are stored, in the image's coordinates
  int left = 0, top = 0;        ///< of the image, in the file's own coordinates
  bool stored_differs = false;  ///< other parts of the file store other pixels
  Size size;                    ///< of the image as stored, before its orientation is applied
  int slices = 1;
  int orientation = 1;  ///< EXIF orientation tag
  std::vector<std::string> channels;
  Depth depth = Depth::u8;    ///< the smallest depth that holds every value
  std::string type;           ///< of the stored values; "mixed depth" if channels differ
  bool exact = true;          ///< the stored values have exactly that depth
  bool deep = false;          ///< several samples per pixel
  bool inks = false;          ///< the colours are printing inks
  bool by_rows = false;       ///< the decoder works row by row and needs little memory
  std::string description{};  ///< as write_image stores it; empty if there is none
  std::string color_space{};  ///< "lin_rec709" if the file says that its colours are linear; else empty
  std::string note{};         ///< a note for the user, as a clause
};

/// An open image file.
class ImageDecoder {
 public:
  virtual ~ImageDecoder() = default;
  /// Of the selected layer.
  virtual const StoredImage& header() const = 0;
  virtual bool has_more_images() = 0;
  /// The parts of an EXR file, and its groups of channels with a common prefix: "normal" of normal.X, normal.Y and
  /// normal.Z. Channels without a prefix form the layer "". Other files have only the layer "".
  virtual std::vector<std::string> layers() const { return {""}; }
  /// Selects a layer by its index in layers(); initially the first.
  virtual void select(size_t) {}
  /// Makes later reads drop the last of two or four channels.
  virtual void drop_alpha() {}
  /// Reads all stored pixels of the selected layer, channels interleaved.
  virtual void read(Depth as, void* out) = 0;
  /// Reads the next rows, from `first` up to but excluding `end`, in order from top to bottom. Each call reads a
  /// multiple of row_step() rows, except the last. Requires `by_rows` in the header.
  virtual void read_rows(int first, int end, Depth as, void* out) = 0;
  virtual int row_step() const { return 1; }
};

/// Receives an encoder's bytes, which may overwrite earlier ones.
class ByteSink {
 public:
  virtual ~ByteSink() = default;
  /// Returns false if the write failed.
  virtual bool write(uint64_t offset, const void* data, size_t size) = 0;
};

/// The image that an encoder writes.
struct EncodedImage {
  Size size;
  int channels = 1;
  bool has_alpha = false;  ///< in the last channel
  std::string color_space{};
  WriteOptions options{};
};

class ImageEncoder {
 public:
  virtual ~ImageEncoder() = default;
  /// Writes the next rows; values of the file's depth.
  virtual void write_rows(int first, int end, const void* values) = 0;
  /// Ends a mip level and begins the next.
  virtual void next_level(Size) {}
  virtual void finish() = 0;
};

/// External references of a configuration, with environment variables expanded.
struct ColorSources {
  std::vector<std::string> files{};                ///< of its transforms; some may not exist
  std::vector<std::string> folders{};              ///< search folders; absolute
  std::map<std::string, std::string> variables{};  ///< the environment variables that it uses, by name
};

/// Colour spaces by name. Thread-safe.
class ColorConfiguration {
 public:
  /// Converts `count` pixels in place, the first three of `channels` values of each.
  using Conversion = std::function<void(float* pixels, int channels, int64_t count)>;

  virtual ~ColorConfiguration() = default;
  virtual std::vector<std::string> names() const = 0;
  /// The configuration's own name for a space, alias or role; empty if there is none.
  virtual std::string find(const std::string& name) const = 0;
  virtual Conversion conversion(const std::string& from, const std::string& to) const = 0;
  /// The files that OpenColorIO reads for that conversion.
  virtual std::vector<std::string> files_of(const std::string& from, const std::string& to) const = 0;
  virtual ColorSources sources() const = 0;
  /// Expands environment variables in a text and adds them to `variables`.
  virtual std::string expanded(const std::string& text, std::map<std::string, std::string>& variables) const = 0;
};

struct ImageLibraries {
  std::unique_ptr<ImageDecoder> (*open_image)(const std::string& path);
  /// For all formats except PNG. Writes to `sink`, or to the file `name` if `sink` is null.
  std::unique_ptr<ImageEncoder> (*create_image)(const std::string& name, const EncodedImage& image, ByteSink* sink);
  /// Parses the text of the OpenColorIO configuration file at `path`; an empty path gives the built-in configuration of
  /// core/image_io/color.h. Clears OpenColorIO's cache of look-up files.
  std::shared_ptr<const ColorConfiguration> (*load_colors)(const std::string& path, const std::string& text);
};

/// Throws Error if the module is missing; does not load it.
void require_image_libraries();

/// Loads the module when it is first called. Throws Error if it cannot be loaded. Thread-safe.
const ImageLibraries& image_libraries();

}  // namespace terrazzo
