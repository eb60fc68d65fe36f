#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/image/image.h"
#include "core/image/image_limits.h"

/// Pixels of image files that exceed their share of the memory budget.
namespace terrazzo {

/// The layout of an image's pixels in a file.
struct PixelLayout {
  Depth depth = Depth::u8;  ///< of the stored values
  Rect stored;              ///< in the image's coordinates; pixels outside are 0
  Size size;                ///< of the image as stored, before its orientation is applied
  int orientation = 1;      ///< as in EXIF
  int channels = 1;

  bool is_turned() const { return orientation >= 5; }
  Size upright() const { return is_turned() ? Size{size.height, size.width} : size; }
};

/// An image's stored values in a scratch file. They are read as upright floats: 8-bit values as k / 255, 16-bit values
/// as k / 65535. Thread-safe for reading once all are written. Throws Error if the disk fails.
class FilePixels : public PixelSource {
 public:
  /// Null if there is no room on disk.
  static std::shared_ptr<FilePixels> make(const PixelLayout& layout);
  ~FilePixels() override;
  FilePixels(const FilePixels&) = delete;
  FilePixels& operator=(const FilePixels&) = delete;

  /// Writes stored rows from `first` on; values of the layout's depth.
  void write_rows(int first, int rows, const void* values);
  /// Reads stored pixels as floats without applying the orientation.
  void read_stored_floats(const Rect& region, float* out) const;
  /// Replaces one value; `x` and `y` count from the first stored pixel. The depth must be a float type.
  void replace(int x, int y, int channel, float value);
  /// Makes later reads return 1 for the last channel.
  void make_opaque() { is_opaque_ = true; }
  /// Makes later reads return v * 0.5 + 0.5, the encoding of normals.
  void encode() { encodes_ = true; }
  void read(const Rect& region, float* out) const override;
  /// An image of the written pixels, with the digest of Image::from_halfs for halfs, else of Image::from_floats.
  static ImagePtr image(const ImageInfo& info, const std::shared_ptr<const FilePixels>& pixels);

 private:
  FilePixels(const PixelLayout& layout, uint64_t at) : layout_(layout), at_(at) {}
  uint64_t bytes() const;
  Rect as_stored(const Rect& region) const;
  template <typename T>
  void read_stored(const Rect& region, T* out) const;
  template <typename T>
  void read_upright(const Rect& region, T* out) const;
  template <typename T>
  void read_as_stored(const Rect& region, T* out) const;
  template <typename T, typename Convert>
  void read_as(const Rect& region, float* out, const Convert& convert) const;

  const PixelLayout layout_;
  const uint64_t at_;  ///< offset in the scratch file
  bool encodes_ = false, is_opaque_ = false;
};

/// An image of the source's pixels, which are read once now, strip by strip, to compute the digest. The digest equals
/// that of Image::from_floats.
ImagePtr image_of_source(ImageInfo info, std::shared_ptr<const PixelSource> source);

/// The same, but keeps the pixels in memory if they fit into their share of the memory budget.
ImagePtr held_or_read(ImageInfo info, std::shared_ptr<const PixelSource> source);

/// The given channels of an image, in that order, with values 1 - v if `inverted`. Kept in memory as by held_or_read.
ImagePtr chosen_channels(const ImagePtr& image, ImageInfo info, const std::vector<int>& channels, bool inverted);

}  // namespace terrazzo
