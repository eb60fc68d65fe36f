#include "core/image/image.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include <Imath/half.h>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image/image_limits.h"

namespace terrazzo {

namespace {

/// Pixels in memory as values of type T, of which `Convert` makes floats.
template <typename T, typename Convert>
class HeldPixels : public PixelSource {
 public:
  HeldPixels(const ImageInfo& info, std::vector<T> pixels)
      : stride_(size_t(info.size.width) * info.channels),
        channels_(info.channels),
        pixels_(std::move(pixels)),
        room_(pixels_.size() * sizeof(T)) {}
  void read(const Rect& r, float* out) const override {
    const size_t row = size_t(r.width) * channels_;
    for (int y = 0; y < r.height; y++) {
      const T* in = &pixels_[size_t(r.y + y) * stride_ + size_t(r.x) * channels_];
      out = std::transform(in, in + row, out, Convert());
    }
  }
  const float* in_memory() const override {
    if constexpr (std::is_same_v<T, float>) return pixels_.data();
    return nullptr;
  }
  uint64_t held_bytes() const override { return pixels_.size() * sizeof(T); }

 private:
  size_t stride_;
  int channels_;
  std::vector<T> pixels_;
  PixelRoom room_;
};

struct FromHalf {
  float operator()(uint16_t bits) const { return imath_half_to_float(bits); }
};
struct FromInteger {
  template <typename T>
  float operator()(T v) const {
    constexpr float largest = std::numeric_limits<T>::max();
    return float(v) / largest;
  }
};

size_t value_count(const ImageInfo& info) {
  return size_t(info.size.area()) * info.channels;
}

template <typename T>
Digest pixel_digest(const ImageInfo& info, const std::vector<T>& pixels) {
  Hasher h;
  h.add("image");
  info.add_to(h);
  h.bytes(pixels.data(), pixels.size() * sizeof(T));
  return h.digest();
}

}  // namespace

std::optional<Semantic> semantic_from(std::string_view name) {
  const auto at = std::find(semantic_names.begin(), semantic_names.end(), name);
  if (at == semantic_names.end()) return std::nullopt;
  return static_cast<Semantic>(at - semantic_names.begin());
}

std::string_view name_of(Depth depth) {
  constexpr std::array<std::string_view, 4> names = {"uint8", "uint16", "half", "float"};
  return names[static_cast<size_t>(depth)];
}

bool is_color(Semantic semantic) {
  return semantic == Semantic::base_color || semantic == Semantic::emission || semantic == Semantic::specular;
}

bool is_one_value(Semantic semantic) {
  return !is_color(semantic) && semantic != Semantic::normal && semantic != Semantic::data &&
         semantic != Semantic::guidance;
}

void ImageInfo::check() const {
  if (size.width <= 0 || size.height <= 0 || channels < 1 || channels > 4)
    throw Error(fmt::format("expected an image of at least 1x1 pixels and 1 to 4 channels, found {}x{} pixels and {}",
                            size.width, size.height, counted(channels, "channel")));
}

void ImageInfo::add_to(Hasher& h) const {
  h.add(size.width)
      .add(size.height)
      .add(channels)
      .add(int(semantic))
      .add(color_space)
      .add(int(depth))
      .add(int(normal_y));
}

Image::Image(ImageInfo info, const Digest& digest, std::shared_ptr<const PixelSource> source)
    : info_(std::move(info)), digest_(digest), source_(std::move(source)) {}

ImagePtr Image::from_floats(ImageInfo info, std::vector<float> pixels) {
  info.check();
  if (pixels.size() != value_count(info)) throw std::logic_error("pixel count does not match the image's size");
  const Digest digest = pixel_digest(info, pixels);
  auto source = std::make_shared<HeldPixels<float, std::identity>>(info, std::move(pixels));
  return ImagePtr(new Image(std::move(info), digest, std::move(source)));
}

ImagePtr Image::from_halfs(ImageInfo info, std::vector<uint16_t> pixels) {
  info.check();
  if (pixels.size() != value_count(info)) throw std::logic_error("pixel count does not match the image's size");
  const Digest digest = pixel_digest(info, pixels);
  auto source = std::make_shared<HeldPixels<uint16_t, FromHalf>>(info, std::move(pixels));
  return ImagePtr(new Image(std::move(info), digest, std::move(source)));
}

template <typename T>
ImagePtr Image::from_integers(ImageInfo info, std::vector<T> pixels) {
  info.check();
  if (pixels.size() != value_count(info)) throw std::logic_error("pixel count does not match the image's size");
  const auto source = std::make_shared<HeldPixels<T, FromInteger>>(info, std::move(pixels));
  Hasher h;
  h.add("image");
  info.add_to(h);
  h.add(int64_t(value_count(info) * sizeof(float)));
  std::vector<float> row(size_t(info.size.width) * info.channels);
  for (int y = 0; y < info.size.height; y++) {
    source->read({0, y, info.size.width, 1}, row.data());
    h.stream(row.data(), row.size() * sizeof(float));
  }
  return ImagePtr(new Image(std::move(info), h.digest(), source));
}
template ImagePtr Image::from_integers(ImageInfo info, std::vector<uint8_t> pixels);
template ImagePtr Image::from_integers(ImageInfo info, std::vector<uint16_t> pixels);

namespace {

/// Releases a source, possibly the last reference to a long chain of images, without recursion.
void release_later(std::shared_ptr<const PixelSource> source) {
  static thread_local std::vector<std::shared_ptr<const PixelSource>>* pending = nullptr;
  if (!source) return;
  if (pending) return pending->push_back(std::move(source));
  std::vector<std::shared_ptr<const PixelSource>> released;
  pending = &released;
  while (source) {
    source.reset();  // appends its sources to the queue
    if (released.empty()) continue;
    source = std::move(released.back());
    released.pop_back();
  }
  pending = nullptr;
}

}  // namespace

Image::~Image() {
  release_later(std::move(source_));
}

ImagePtr Image::with_digest(ImageInfo info, const Digest& digest, std::shared_ptr<const PixelSource> source) {
  info.check();
  if (!source) throw std::logic_error("an image needs a source of pixels, found null");
  return ImagePtr(new Image(std::move(info), digest, std::move(source)));
}

ImagePtr Image::redescribed(const ImagePtr& image, ImageInfo info) {
  if (info == image->info()) return image;
  if (info.size != image->size() || info.channels != image->channels())
    throw std::logic_error("another description must keep size and channels");
  Hasher h;
  h.add("redescribed image").add(image->digest());
  info.add_to(h);
  return ImagePtr(new Image(std::move(info), h.digest(), image->source_));
}

PixelView::PixelView(const Image& image)
    : size_(image.size()), channels_(image.channels()), source_(image.source().get()) {}

PixelView::PixelView(const Image& image, const std::vector<PixelBlock>& blocks) : PixelView(image) {
  blocks_ = &blocks;
}

const PixelBlock& PixelView::block_around(const Rect& region) const {
  for (const PixelBlock& block : *blocks_)
    if (intersect(block.rect, region) == region) return block;
  throw std::logic_error("an operation reads pixels that it has not asked for");
}

void PixelView::read(const Rect& region, float* out) const {
  if (!blocks_) return source_->read(region, out);
  const PixelBlock& block = block_around(region);
  const size_t row = size_t(region.width) * channels_, stride = size_t(block.rect.width) * channels_;
  const float* in = block.pixels.get() + (region.y - block.rect.y) * stride + (region.x - block.rect.x) * channels_;
  for (int y = 0; y < region.height; y++) std::copy_n(in + y * stride, row, out + y * row);
}

std::vector<float> PixelView::read(const Rect& region) const {
  std::vector<float> out(size_t(region.area()) * channels_);
  read(region, out.data());
  return out;
}

const float* PixelView::in_place(const Rect& region) const {
  const PixelBlock* block = blocks_ ? &block_around(region) : nullptr;
  const Rect all = block ? block->rect : whole(size_);
  const float* pixels = block ? block->pixels.get() : source_->in_memory();
  if (!pixels || (region.width != all.width && region.height != 1)) return nullptr;
  return pixels + (size_t(region.y - all.y) * all.width + (region.x - all.x)) * channels_;
}

std::vector<float> Image::read(const Rect& region) const {
  std::vector<float> out(size_t(region.area()) * channels());
  read(region, out.data());
  return out;
}

namespace {

/// Consecutive positions along one axis of a padded region that show consecutive positions of the image, or all the
/// same one.
struct Run {
  int at = 0;      ///< in the region
  int source = 0;  ///< in the image
  int count = 0;
  bool repeats = false;  ///< all show the position `source`
};

std::vector<Run> runs_of(int first, int count, int length, Outside outside) {
  std::vector<Run> runs;
  for (int i = 0; i < count;) {
    const int v = first + i;
    Run run{i, outside == Outside::wrap ? wrap(v, length) : std::clamp(v, 0, length - 1), 0, false};
    run.repeats = outside == Outside::clamp && (v < 0 || v >= length);
    run.count = std::min(count - i, !run.repeats ? length - run.source : v < 0 ? -v : count - i);
    runs.push_back(run);
    i += run.count;
  }
  return runs;
}

Rect block_of(const Run& columns, const Run& rows) {
  return {columns.source, rows.source, columns.repeats ? 1 : columns.count, rows.repeats ? 1 : rows.count};
}

}  // namespace

std::vector<Rect> padded_parts(Size size, const Rect& region, Outside outside) {
  if (intersect(region, whole(size)) == region) return {region};
  std::vector<Rect> parts;
  const std::vector<Run> columns = runs_of(region.x, region.width, size.width, outside);
  for (const Run& rows : runs_of(region.y, region.height, size.height, outside))
    for (const Run& run : columns) parts.push_back(block_of(run, rows));
  return parts;
}

std::vector<float> read_padded(const PixelView& image, const Rect& region, Outside outside) {
  const int c = image.channels();
  if (intersect(region, whole(image.size())) == region) return image.read(region);
  std::vector<float> out(size_t(region.area()) * c);
  const std::vector<Run> columns = runs_of(region.x, region.width, image.size().width, outside);
  for (const Run& rows : runs_of(region.y, region.height, image.size().height, outside))
    for (const Run& run : columns) {
      const Rect block = block_of(run, rows);
      const std::vector<float> pixels = image.read(block);
      for (int y = 0; y < rows.count; y++)
        for (int x = 0; x < run.count; x++)
          std::copy_n(&pixels[(size_t(rows.repeats ? 0 : y) * block.width + (run.repeats ? 0 : x)) * c], c,
                      &out[(size_t(rows.at + y) * region.width + run.at + x) * c]);
    }
  return out;
}

namespace {
int rows_of_a_strip(const Image& image) {
  return std::max<int>(1, int((int64_t{1} << 20) / (int64_t{image.width()} * image.channels())));
}
}  // namespace

void for_each_strip(const Image& image, const std::function<void(const Rect&, const float*)>& visit) {
  const int rows = rows_of_a_strip(image);
  std::vector<float> buffer;
  for (int y = 0; y < image.height(); y += rows) {
    CurrentTask::task().check();
    const Rect r{0, y, image.width(), std::min(rows, image.height() - y)};
    if (const float* all = image.in_memory()) {
      visit(r, all + size_t(y) * image.width() * image.channels());
      continue;
    }
    buffer.resize(size_t(r.area()) * image.channels());
    image.read(r, buffer.data());
    visit(r, buffer.data());
  }
}

void for_each_strip_at_once(const Image& image, int rows, const Task& task,
                            const std::function<void(const Rect&, const float*)>& visit) {
  tbb::parallel_for(0, (image.height() + rows - 1) / rows, [&](int strip) {
    const CurrentTask scope(task);
    task.check();
    const Rect r{0, strip * rows, image.width(), std::min(rows, image.height() - strip * rows)};
    if (const float* all = image.in_memory())
      visit(r, all + size_t(r.y) * image.width() * image.channels());
    else
      visit(r, image.read(r).data());
  });
}

ImagePtr held(const ImagePtr& image, const Task& task) {
  return image->source()->held_bytes() > 0 ? image : materialized(image, task);
}

ImagePtr materialized(const ImagePtr& image, const Task& task) {
  if (image->in_memory()) return image;
  const ImageInfo& info = image->info();
  std::vector<float> pixels(value_count(info));
  const int rows = std::min(64, rows_of_a_strip(*image));
  const int strips = (info.size.height + rows - 1) / rows;
  std::atomic<int> done{0};
  tbb::parallel_for(0, strips, [&](int strip) {
    const CurrentTask scope(task);
    task.progress(double(done++) / strips);
    const int y = strip * rows;
    image->read({0, y, info.size.width, std::min(rows, info.size.height - y)},
                &pixels[size_t(y) * info.size.width * info.channels]);
  });
  return Image::from_floats(info, std::move(pixels));
}

}  // namespace terrazzo
