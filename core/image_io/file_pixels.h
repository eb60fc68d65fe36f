#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/image/image.h"
#include "core/image/image_limits.h"

/// Pixels of image files that do not fit into their share of the memory budget.
namespace terrazzo {

/// How an image lies in a file.
struct PixelLayout {
  Depth depth = Depth::u8;  ///< of the values that are kept
  Rect stored;              ///< in the image's coordinates; what is not stored is 0
  Size size;                ///< of the image as stored, before it is turned
  int orientation = 1;      ///< as in EXIF
  int channels = 1;

  bool is_turned() const { return orientation >= 5; }
  Size upright() const { return is_turned() ? Size{size.height, size.width} : size; }
};

/// An image's stored values in a scratch file, from which they are read as floats, upright: of 8 bits k / 255, of 16
/// bits k / 65535. Thread-safe for reading once all are written. Throws Error if the disk fails.
class FilePixels : public PixelSource {
 public:
  /// Null if there is no room on disk.
  static std::shared_ptr<FilePixels> make(const PixelLayout& layout);
  ~FilePixels() override;
  FilePixels(const FilePixels&) = delete;
  FilePixels& operator=(const FilePixels&) = delete;

  /// Stored rows from `first` on, values of the layout's depth.
  void write_rows(int first, int rows, const void* values);
  /// Stored pixels as they are, whole rows or parts of them.
  void read_stored_floats(const Rect& region, float* out) const;
  /// Replaces one value, counted from the first stored pixel. The depth must be of floats.
  void replace(int x, int y, int channel, float value);
  /// From now on the last channel comes as 1.
  void make_opaque() { is_opaque_ = true; }
  /// From now on values come as v * 0.5 + 0.5, as normals are encoded.
  void encode() { encodes_ = true; }
  void read(const Rect& region, float* out) const override;
  /// The image of all that has been written; digest as Image::from_halfs gives for halfs, else Image::from_floats.
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
  const uint64_t at_;  ///< where they begin in the scratch file
  bool encodes_ = false, is_opaque_ = false;
};

/// An image of pixels that `source` has and that are read once now, strip by strip, for the digest: the same as
/// Image::from_floats gives.
ImagePtr image_of_source(ImageInfo info, std::shared_ptr<const PixelSource> source);

/// The same, but read whole now if the pixels fit into their share of the memory budget.
ImagePtr held_or_read(ImageInfo info, std::shared_ptr<const PixelSource> source);

/// Some channels of an image, in that order, each value v as 1 - v if `inverted`; see held_or_read.
ImagePtr chosen_channels(const ImagePtr& image, ImageInfo info, const std::vector<int>& channels, bool inverted);

}  // namespace terrazzo
