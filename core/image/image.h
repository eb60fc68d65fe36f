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
/// Whether maps of this semantic have one channel of values.
bool is_one_value(Semantic semantic);

/// The bit depth that an image had in its file (`export` keeps it) or is to be written with.
enum class Depth : uint8_t { u8, u16, f16, f32 };
std::string_view name_of(Depth depth);

/// Which way the green channel of a tangent-space normal map points: OpenGL (up) or DirectX (down).
enum class NormalY : uint8_t { up, down };

/// The description of an image: everything except its pixels.
struct ImageInfo {
  Size size;
  int channels = 1;  ///< 1..4
  Semantic semantic = Semantic::data;
  std::string color_space = "raw";  ///< a name that core/image_io/color.h knows; "raw" is never converted
  Depth depth = Depth::f32;
  NormalY normal_y = NormalY::up;  ///< only for Semantic::normal: how to interpret the pixels, which stay as read
  bool operator==(const ImageInfo&) const = default;
  void add_to(Hasher& hasher) const;
  /// Throws Error if the description is invalid.
  void check() const;
};

/// A source of pixels: memory, a file, or a computation on demand.
class PixelSource {
 public:
  virtual ~PixelSource() = default;
  /// Writes the region row by row, channels interleaved. `region` lies inside the image. Thread-safe.
  virtual void read(const Rect& region, float* out) const = 0;
  /// All pixels if they are in memory as floats; else null.
  virtual const float* in_memory() const { return nullptr; }
  /// The bytes of pixels that it holds in memory, in whatever form; 0: it reads or computes them.
  virtual uint64_t held_bytes() const { return 0; }
};

class Image;
using ImagePtr = std::shared_ptr<const Image>;

/// The pixels of a part of an image, row by row, channels interleaved.
struct PixelBlock {
  Rect rect;
  std::unique_ptr<float[]> pixels;
};

/// An operation's view of a source image: the image itself, or precomputed blocks of it. Must not outlive either.
class PixelView {
 public:
  PixelView(const Image& image);  // NOLINT(google-explicit-constructor): every image can be read
  PixelView(const Image& image, const std::vector<PixelBlock>& blocks);

  Size size() const { return size_; }
  int channels() const { return channels_; }
  /// As Image::read; the region must lie inside one of the blocks, if there are any.
  void read(const Rect& region, float* out) const;
  std::vector<float> read(const Rect& region) const;
  /// The region's pixels without a copy if they are contiguous floats in memory; else null.
  const float* in_place(const Rect& region) const;

 private:
  const PixelBlock& block_around(const Rect& region) const;
  Size size_;
  int channels_;
  const PixelSource* source_;
  const std::vector<PixelBlock>* blocks_ = nullptr;
};

/// How to compute an image from source images.
struct Operation {
  std::vector<ImagePtr> sources;
  /// The parts of a source that a region of the result depends on, each inside the source. Default: the same region.
  std::function<std::vector<Rect>(size_t source, const Rect& region)> reads{};
  /// Computes the pixels of a region. May read a source only inside the parts that `reads` returns. Must be thread-safe
  /// and must not wait for work on other threads.
  std::function<void(std::span<const PixelView> sources, const Rect& region, float* out)> compute;
  /// The approximate number of operations per value of the result: the cost of computing pixels twice. Does not affect
  /// the result.
  double work = 1;
  /// Always compute the pixels as a whole and keep them: for operations with large neighbourhoods. Does not affect the
  /// result.
  bool keeps = false;
};

/// An immutable, thread-safe image: a description and a source of pixels, read region by region. Values from 8- and
/// 16-bit files are in [0, 1] and are written back exactly to a file of the same depth. Normals are stored encoded (n *
/// 0.5 + 0.5), in the convention of `info().normal_y`.
class Image {
 public:
  /// An image in memory, of `info.size.area() * info.channels` floats.
  static ImagePtr from_floats(ImageInfo info, std::vector<float> pixels);
  /// The same for IEEE half floats, as bit patterns.
  static ImagePtr from_halfs(ImageInfo info, std::vector<uint16_t> pixels);
  /// The same for values k / 255 of uint8_t, or k / 65535 of uint16_t, which stay integers in memory. The digest is
  /// that of from_floats.
  template <typename T>
  static ImagePtr from_integers(ImageInfo info, std::vector<T> pixels);
  /// An image computed from others on demand, see core/image/computed_pixels.h. `recipe` must cover everything that the
  /// pixels depend on: it replaces their content in the digest.
  static ImagePtr computed(ImageInfo info, const Digest& recipe, Operation operation);
  /// The same for pixels that depend on no other image, or only on images in memory.
  static ImagePtr computed(ImageInfo info, const Digest& recipe, std::shared_ptr<const PixelSource> source);
  static ImagePtr computed(ImageInfo info, const Digest& recipe,
                           std::function<void(const Rect& region, float* out)> read);
  /// An image whose digest is already known, such as one stored in the cache.
  static ImagePtr with_digest(ImageInfo info, const Digest& digest, std::shared_ptr<const PixelSource> source);
  /// The same pixels with another description. Size and channels must not change.
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
  /// Cancelled if pixels must be computed and the thread's task (see CurrentTask) is cancelled; Error if they cannot be
  /// computed (see PixelError).
  void read(const Rect& region, float* out) const { source_->read(region, out); }
  std::vector<float> read(const Rect& region) const;
  /// The whole image as floats.
  std::vector<float> pixels() const { return read(whole(size())); }
  /// All pixels without a copy if they are in memory as floats; else null.
  const float* in_memory() const { return source_->in_memory(); }
  /// The source of the pixels, shared by images that differ only in their description.
  const std::shared_ptr<const PixelSource>& source() const { return source_; }

 private:
  Image(ImageInfo info, const Digest& digest, std::shared_ptr<const PixelSource> source);
  ImageInfo info_;
  Digest digest_;
  std::shared_ptr<const PixelSource> source_;
};

/// How an image continues outside its borders: border pixels repeat, or the image wraps around.
enum class Outside : uint8_t { clamp, wrap };
std::vector<float> read_padded(const PixelView& image, const Rect& region, Outside outside);
/// The parts of an image of this size that read_padded reads.
std::vector<Rect> padded_parts(Size size, const Rect& region, Outside outside);

/// Pulls an image strip by strip (full-width bands of rows, top to bottom): the way to look at every pixel without
/// holding the image. `visit(region, pixels)`; strips hold about a million floats.
void for_each_strip(const Image& image, const std::function<void(const Rect&, const float*)>& visit);

/// The same by all threads, in any order, several strips of so many rows at once. Throws Cancelled.
void for_each_strip_at_once(const Image& image, int rows, const Task& task,
                            const std::function<void(const Rect&, const float*)>& visit);

/// An image whose pixels lie in memory in some form, so that reading a few of them is quick: `image` itself if they do
/// already, else as floats.
ImagePtr held(const ImagePtr& image, const Task& task = CurrentTask::task());

/// An image whose pixels lie in memory as floats: `image` itself if they do already, else a copy that has been pulled,
/// in parallel. Tells `task` how far it is.
ImagePtr materialized(const ImagePtr& image, const Task& task = CurrentTask::task());

}  // namespace terrazzo
