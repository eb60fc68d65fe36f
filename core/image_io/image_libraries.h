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

/// What terrazzo uses of OpenImageIO and OpenColorIO. The two bring some 250 shared libraries along, and linking those
/// takes ten times as long as a run that finds everything cached. So what uses them (core/image_io/libraries/) is a
/// module of its own, which is loaded when something is first asked of it. The module knows nothing of the rest of
/// terrazzo but headers. Every function throws Error with the library's own reason.
namespace terrazzo {

/// What an image file says of itself.
struct StoredImage {
  std::string format;           ///< the library's name for it: "png", "jpeg", "tiff", "openexr", ...
  Rect stored;                  ///< the pixels that are stored, in the image's coordinates
  int left = 0, top = 0;        ///< of the image, in the file's own coordinates
  bool stored_differs = false;  ///< other parts of the file store other pixels
  Size size;                    ///< of the image as stored, before it is turned
  int slices = 1;
  int orientation = 1;  ///< as in EXIF
  std::vector<std::string> channels;
  Depth depth = Depth::u8;    ///< the smallest that holds every value
  std::string type;           ///< of the stored values; "mixed depth" if channels differ
  bool exact = true;          ///< the stored values are of just that depth
  bool deep = false;          ///< several samples per pixel
  bool inks = false;          ///< the colours are printing inks
  bool by_rows = false;       ///< decoded row by row: a decoder holds little of it at once
  std::string description{};  ///< as write_image stores it; empty if there is none
  std::string color_space{};  ///< "lin_rec709" if the file says that its colours are linear; else empty
  std::string note{};         ///< what the user should know, a part of a sentence
};

/// An open image file.
class ImageDecoder {
 public:
  virtual ~ImageDecoder() = default;
  /// Of the selected layer.
  virtual const StoredImage& header() const = 0;
  virtual bool has_more_images() = 0;
  /// Parts of an EXR file, and channels of one prefix in it: "normal" of normal.X, normal.Y and normal.Z. The one of
  /// channels without a prefix is "". At least one; other files have only "".
  virtual std::vector<std::string> layers() const { return {""}; }
  /// Index into layers(); the first is selected to begin with.
  virtual void select(size_t) {}
  /// Reads two or four channels without the last from now on.
  virtual void drop_alpha() {}
  /// Reads the stored pixels of the selected layer, all channels of each together.
  virtual void read(Depth as, void* out) = 0;
  /// Reads the next rows of them, from `first` on up to `end`: top to bottom, a multiple of row_step() at a time but
  /// for the last. Only if the header says `by_rows`.
  virtual void read_rows(int first, int end, Depth as, void* out) = 0;
  virtual int row_step() const { return 1; }
};

/// Where an encoder puts bytes; it may go back to what it has written.
class ByteSink {
 public:
  virtual ~ByteSink() = default;
  /// False if they could not be written.
  virtual bool write(uint64_t offset, const void* data, size_t size) = 0;
};

/// What an encoder is to write.
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
  /// The next rows, values of the file's depth.
  virtual void write_rows(int first, int end, const void* values) = 0;
  /// Ends the level, and begins the next of a mip chain.
  virtual void next_level(Size) {}
  virtual void finish() = 0;
};

/// What a configuration names outside of its own text, with its variables of the environment filled in.
struct ColorSources {
  std::vector<std::string> files{};    ///< of its transforms; not all need to be there
  std::vector<std::string> folders{};  ///< in which files without a folder of their own are looked for; absolute
  std::map<std::string, std::string> variables{};  ///< that it uses, by name
};

/// Colour spaces by name. Thread-safe.
class ColorConfiguration {
 public:
  /// Converts `count` pixels in place, the first three of `channels` values of each.
  using Conversion = std::function<void(float* pixels, int channels, int64_t count)>;

  virtual ~ColorConfiguration() = default;
  virtual std::vector<std::string> names() const = 0;
  /// What the configuration calls a space that may go by an alias or a role; empty if it has none of that name.
  virtual std::string find(const std::string& name) const = 0;
  virtual Conversion conversion(const std::string& from, const std::string& to) const = 0;
  /// The files that OpenColorIO reads for that conversion.
  virtual std::vector<std::string> files_of(const std::string& from, const std::string& to) const = 0;
  virtual ColorSources sources() const = 0;
  /// A text with its variables of the environment filled in; adds these to `variables`.
  virtual std::string expanded(const std::string& text, std::map<std::string, std::string>& variables) const = 0;
};

struct ImageLibraries {
  std::unique_ptr<ImageDecoder> (*open_image)(const std::string& path);
  /// For all formats but PNG. Writes to `sink`, or to the file `name` if that is null.
  std::unique_ptr<ImageEncoder> (*create_image)(const std::string& name, const EncodedImage& image, ByteSink* sink);
  /// The text of an OpenColorIO configuration file at that path; the spaces of core/color.h if the path is empty.
  /// Forgets all look-up files that have been read.
  std::shared_ptr<const ColorConfiguration> (*load_colors)(const std::string& path, const std::string& text);
};

/// Throws Error if the module is missing; does not load it.
void require_image_libraries();

/// Loads the module when it is first called. Throws Error if it cannot be loaded. Thread-safe.
const ImageLibraries& image_libraries();

}  // namespace terrazzo
