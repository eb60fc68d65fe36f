#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/hash.h"
#include "core/base/task.h"

namespace terrazzo {

/// What a map means. It decides how the map is weighted, filtered, resolved and written.
enum class Semantic : uint8_t {
  base_color,
  normal,
  height,
  roughness,
  metallic,
  ambient_occlusion,
  opacity,
  emission,
  specular,
  mask,
  guidance,
  data,
};
inline constexpr std::array<std::string_view, 12> semantic_names = {
    "base_color", "normal",   "height",   "roughness", "metallic", "ambient_occlusion",
    "opacity",    "emission", "specular", "mask",      "guidance", "data"};
inline std::string_view name_of(Semantic s) {
  return semantic_names[static_cast<size_t>(s)];
}
std::optional<Semantic> semantic_from(std::string_view name);
bool is_color(Semantic semantic);
/// Whether a map of that meaning has one value at a pixel.
bool is_one_value(Semantic semantic);

/// The depth an image had in its file (`export` keeps it) or should be written with.
enum class Depth : uint8_t { u8, u16, f16, f32 };
std::string_view name_of(Depth depth);

/// Which way the green channel of a tangent-space normal map points: OpenGL (up) or DirectX (down).
enum class NormalY : uint8_t { up, down };

/// Everything about an image but its pixels.
struct ImageInfo {
  Size size;
  int channels = 1;  ///< 1..4
  Semantic semantic = Semantic::data;
  std::string color_space = "raw";  ///< a name that core/image_io/color.h knows; "raw" is never converted
  Depth depth = Depth::f32;
  NormalY normal_y =
      NormalY::up;  ///< only meaningful for Semantic::normal; pixels stay as they came, this tells how to read them
  bool operator==(const ImageInfo&) const = default;
  void add_to(Hasher& hasher) const;
  /// Throws Error unless an image may be so.
  void check() const;
};

/// A way to get at pixels: from memory, from a file, or computed when asked for.
class PixelSource {
 public:
  virtual ~PixelSource() = default;
  /// Writes the region row by row, channels interleaved. `region` lies inside the image. Safe to call from any number
  /// of threads at once.
  virtual void read(const Rect& region, float* out) const = 0;
  /// All pixels, if they lie in memory as floats; else null.
  virtual const float* in_memory() const { return nullptr; }
};

class Image;
using ImagePtr = std::shared_ptr<const Image>;

/// The pixels of a part of an image, row by row, channels interleaved.
struct PixelBlock {
  Rect rect;
  std::unique_ptr<float[]> pixels;
};

/// What an operation reads an image's pixels through: the image, or blocks of it that have been computed already. Must
/// not outlive either.
class PixelView {
 public:
  PixelView(const Image& image);  // NOLINT(google-explicit-constructor): every image can be read
  PixelView(const Image& image, const std::vector<PixelBlock>& blocks);

  Size size() const { return size_; }
  int channels() const { return channels_; }
  /// As Image::read; the region must lie inside one of the blocks, if there are any.
  void read(const Rect& region, float* out) const;
  std::vector<float> read(const Rect& region) const;
  /// The region's pixels without a copy, if they lie in memory as floats one after the other; else null.
  const float* in_place(const Rect& region) const;

 private:
  const PixelBlock& block_around(const Rect& region) const;
  Size size_;
  int channels_;
  const PixelSource* source_;
  const std::vector<PixelBlock>* blocks_ = nullptr;
};

/// How the pixels of an image are made from those of others.
struct Operation {
  std::vector<ImagePtr> sources;
  /// The parts of a source that a region of the result is made from, each inside the source; none: the same region.
  std::function<std::vector<Rect>(size_t source, const Rect& region)> reads{};
  /// Makes the pixels of a region. Reads of each source only what lies inside one of the parts that `reads` names. Safe
  /// to call from any number of threads at once; must not wait for work on other threads.
  std::function<void(std::span<const PixelView> sources, const Rect& region, float* out)> compute;
  /// About how many values are multiplied, added or looked up for each value of the result. Weighs what it costs to
  /// compute pixels twice; says nothing about the result.
  double work = 1;
  /// Whether the pixels are computed as a whole and kept in any case: for those that take much of their surroundings to
  /// compute a single row. Says nothing about the result.
  bool keeps = false;
};

/// An immutable picture: a description and a way to read it region by region. Values of maps read from 8- and 16-bit
/// files are in [0, 1] and survive the way to a file of the same depth exactly; normals are stored encoded
/// (n * 0.5 + 0.5), in the convention of `info().normal_y`.
class Image {
 public:
  /// Pixels held in memory, `info.size.area() * info.channels` floats.
  static ImagePtr from_floats(ImageInfo info, std::vector<float> pixels);
  /// The same, kept as IEEE half floats (bit patterns).
  static ImagePtr from_halfs(ImageInfo info, std::vector<uint16_t> pixels);
  /// Pixels computed from other images' when they are asked for, see core/image/computed_pixels.h. `recipe` must cover
  /// everything they depend on: it stands in for the content in the digest.
  static ImagePtr computed(ImageInfo info, const Digest& recipe, Operation operation);
  /// The same for pixels that are made from no other image, or only from images that lie in memory.
  static ImagePtr computed(ImageInfo info, const Digest& recipe, std::shared_ptr<const PixelSource> source);
  static ImagePtr computed(ImageInfo info, const Digest& recipe,
                           std::function<void(const Rect& region, float* out)> read);
  /// Pixels that were kept under a digest before, read from where they lie.
  static ImagePtr with_digest(ImageInfo info, const Digest& digest, std::shared_ptr<const PixelSource> source);
  /// The same pixels under another description; size and channels must not change.
  static ImagePtr redescribed(const ImagePtr& image, ImageInfo info);
  Image(const Image&) = delete;
  Image& operator=(const Image&) = delete;
  ~Image();

  const ImageInfo& info() const { return info_; }
  Size size() const { return info_.size; }
  int width() const { return info_.size.width; }
  int height() const { return info_.size.height; }
  int channels() const { return info_.channels; }
  const Digest& digest() const { return digest_; }

  /// Reads a region that lies inside the image; `out` holds region.area() * channels() floats. Thread-safe. Throws
  /// Cancelled if pixels have to be computed and the task that the thread works for (see CurrentTask) is cancelled.
  void read(const Rect& region, float* out) const { source_->read(region, out); }
  std::vector<float> read(const Rect& region) const;
  /// The whole image as floats.
  std::vector<float> pixels() const { return read(whole(size())); }
  /// All pixels without a copy if they lie in memory as floats; else null.
  const float* in_memory() const { return source_->in_memory(); }
  /// Where the pixels come from; the same for images that differ in their description only.
  const std::shared_ptr<const PixelSource>& source() const { return source_; }

 private:
  Image(ImageInfo info, const Digest& digest, std::shared_ptr<const PixelSource> source);
  ImageInfo info_;
  Digest digest_;
  std::shared_ptr<const PixelSource> source_;
};

/// Reads a region that may stick out of the image; outside it the border pixels continue, or the image wraps around.
enum class Outside : uint8_t { clamp, wrap };
std::vector<float> read_padded(const PixelView& image, const Rect& region, Outside outside);
/// The parts of an image of that size that read_padded reads.
std::vector<Rect> padded_parts(Size size, const Rect& region, Outside outside);

/// Pulls an image strip by strip (full-width bands of rows, top to bottom): the way to look at every pixel without
/// holding the image. `visit(region, pixels)`; strips hold about a million floats.
void for_each_strip(const Image& image, const std::function<void(const Rect&, const float*)>& visit);

/// An image whose pixels lie in memory: `image` itself if they do already, else a copy that has been pulled, in
/// parallel. Tells `task` how far it is.
ImagePtr materialized(const ImagePtr& image, const Task& task = CurrentTask::task());

}  // namespace terrazzo
