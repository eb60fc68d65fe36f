#include "core/image_io/file_pixels.h"

#include <algorithm>
#include <optional>

#include <Imath/half.h>

#include "core/file/scratch_file.h"

namespace terrazzo {

namespace {

constexpr int one_as_half = 0x3c00;
constexpr int64_t values_at_once = int64_t{1} << 18;

size_t bytes_of(Depth depth) {
  return depth == Depth::u8 ? 1 : depth == Depth::f32 ? 4 : 2;
}

uint64_t bytes_of(const PixelLayout& layout) {
  return uint64_t(layout.stored.area()) * uint64_t(layout.channels) * bytes_of(layout.depth);
}

int rows_of(int width, int channels) {
  return int(std::max<int64_t>(1, values_at_once / (int64_t{width} * channels)));
}

/// Visits a region by bands of a few rows.
template <typename Visit>
void for_bands(const Rect& region, int channels, const Visit& visit) {
  const int step = rows_of(region.width, channels);
  for (int y = region.y; y < region.bottom(); y += step)
    visit(Rect{region.x, y, region.width, std::min(step, region.bottom() - y)});
}

}  // namespace

std::shared_ptr<FilePixels> FilePixels::make(const PixelLayout& layout) {
  const std::optional<uint64_t> at = ScratchFile::shared().take(bytes_of(layout));
  return at ? std::shared_ptr<FilePixels>(new FilePixels(layout, *at)) : nullptr;
}

uint64_t FilePixels::bytes() const {
  return bytes_of(layout_);
}

FilePixels::~FilePixels() {
  ScratchFile::shared().give_back(at_, bytes());
}

void FilePixels::read_stored_floats(const Rect& region, float* out) const {
  const Rect at{region.x + layout_.stored.x, region.y + layout_.stored.y, region.width, region.height};
  if (layout_.depth == Depth::f32) return read_stored(at, out);
  std::vector<uint16_t> halfs(size_t(region.area()) * size_t(layout_.channels));
  read_stored(at, halfs.data());
  std::transform(halfs.begin(), halfs.end(), out, [](uint16_t h) { return imath_half_to_float(h); });
}

void FilePixels::replace(int x, int y, int channel, float value) {
  const auto channels = uint64_t(layout_.channels);
  const uint64_t index = (uint64_t(y) * uint64_t(layout_.stored.width) + uint64_t(x)) * channels + uint64_t(channel);
  const uint16_t half = imath_float_to_half(value);
  const void* bytes = layout_.depth == Depth::f16 ? static_cast<const void*>(&half) : &value;
  ScratchFile::shared().write(at_ + index * bytes_of(layout_.depth), bytes, bytes_of(layout_.depth));
}

void FilePixels::write_rows(int first, int rows, const void* values) {
  const uint64_t row = uint64_t(layout_.stored.width) * uint64_t(layout_.channels) * bytes_of(layout_.depth);
  ScratchFile::shared().write(at_ + uint64_t(first) * row, values, uint64_t(rows) * row);
}

/// Where a region of the upright image lies in the image as stored.
Rect FilePixels::as_stored(const Rect& region) const {
  const int o = layout_.orientation;
  const Size to = layout_.upright();
  Rect r = region;
  if (o == 2 || o == 3 || o == 6 || o == 7) r.x = to.width - region.right();
  if (o == 3 || o == 4 || o == 7 || o == 8) r.y = to.height - region.bottom();
  return layout_.is_turned() ? Rect{r.y, r.x, r.height, r.width} : r;
}

/// Reads a region of the stored pixels.
template <typename T>
void FilePixels::read_stored(const Rect& region, T* out) const {
  const Rect& stored = layout_.stored;
  const auto channels = uint64_t(layout_.channels);
  const bool whole_rows = region.width == stored.width;
  const uint64_t count = uint64_t(region.width) * channels * (whole_rows ? uint64_t(region.height) : 1);
  for (int y = 0; y < (whole_rows ? 1 : region.height); y++, out += count) {
    const uint64_t pixel = uint64_t(region.y + y - stored.y) * uint64_t(stored.width) + uint64_t(region.x - stored.x);
    ScratchFile::shared().read(at_ + pixel * channels * sizeof(T), out, count * sizeof(T));
  }
}

template <typename T>
void FilePixels::read_upright(const Rect& region, T* out) const {
  read_as_stored(region, out);
  if (!is_opaque_) return;
  const T one = T(layout_.depth == Depth::f16   ? one_as_half
                  : layout_.depth == Depth::f32 ? 1
                  : layout_.depth == Depth::u8  ? 255
                                                : 65535);
  for (int64_t i = 1; i <= region.area(); i++) out[i * layout_.channels - 1] = one;
}

template <typename T>
void FilePixels::read_as_stored(const Rect& region, T* out) const {
  const Rect all = as_stored(region), from = intersect(all, layout_.stored);
  if (layout_.orientation == 1 && from == all) return read_stored(all, out);
  const int channels = layout_.channels;
  std::fill_n(out, size_t(region.area()) * channels, T{});
  if (from.empty()) return;
  std::vector<T> values(size_t(from.area()) * channels);
  read_stored(from, values.data());
  for (int y = 0; y < region.height; y++)
    for (int x = 0; x < region.width; x++) {
      const Rect at = as_stored({region.x + x, region.y + y, 1, 1});
      if (!contains(from, at.x, at.y)) continue;
      const size_t pixel = size_t(at.y - from.y) * from.width + (at.x - from.x);
      std::copy_n(&values[pixel * channels], channels, out + (size_t(y) * region.width + x) * channels);
    }
}

template <typename T, typename Convert>
void FilePixels::read_as(const Rect& region, float* out, const Convert& convert) const {
  std::vector<T> values;
  for_bands(region, layout_.channels, [&](const Rect& band) {
    values.resize(size_t(band.area()) * layout_.channels);
    read_upright(band, values.data());
    out = std::transform(values.begin(), values.end(), out, convert);
  });
}

void FilePixels::read(const Rect& region, float* out) const {
  switch (layout_.depth) {
    case Depth::u8:
      return read_as<uint8_t>(region, out, [](uint8_t v) { return float(v) / 255.0f; });
    case Depth::u16:
      return read_as<uint16_t>(region, out, [](uint16_t v) { return float(v) / 65535.0f; });
    case Depth::f16:
      return read_as<uint16_t>(region, out, [](uint16_t v) { return imath_half_to_float(v); });
    case Depth::f32:
      return encodes_ ? read_as<float>(region, out, [](float v) { return v * 0.5f + 0.5f; })
                      : read_as<float>(region, out, [](float v) { return v; });
  }
}

ImagePtr FilePixels::image(const ImageInfo& info, const std::shared_ptr<const FilePixels>& pixels) {
  if (pixels->layout_.depth != Depth::f16) return image_of_source(info, pixels);
  Hasher h;
  h.add("image");
  info.add_to(h);
  h.add(info.size.area() * info.channels * int64_t{sizeof(uint16_t)});
  std::vector<uint16_t> halfs;
  for_bands(whole(info.size), info.channels, [&](const Rect& band) {
    halfs.resize(size_t(band.area()) * info.channels);
    pixels->read_upright(band, halfs.data());
    h.stream(halfs.data(), halfs.size() * sizeof(uint16_t));
  });
  return Image::with_digest(info, h.digest(), pixels);
}

ImagePtr image_of_source(ImageInfo info, std::shared_ptr<const PixelSource> source) {
  Hasher h;
  h.add("image");
  info.add_to(h);
  h.add(info.size.area() * info.channels * int64_t{sizeof(float)});
  std::vector<float> pixels;
  for_bands(whole(info.size), info.channels, [&](const Rect& band) {
    pixels.resize(size_t(band.area()) * info.channels);
    source->read(band, pixels.data());
    h.stream(pixels.data(), pixels.size() * sizeof(float));
  });
  return Image::with_digest(std::move(info), h.digest(), std::move(source));
}

namespace {

class ChosenChannels : public PixelSource {
 public:
  ChosenChannels(ImagePtr image, std::vector<int> channels, bool inverted)
      : image_(std::move(image)), channels_(std::move(channels)), inverted_(inverted) {}
  void read(const Rect& region, float* out) const override {
    std::vector<float> pixels;
    for_bands(region, image_->channels(), [&](const Rect& band) {
      pixels.resize(size_t(band.area()) * image_->channels());
      image_->read(band, pixels.data());
      for (const float* p = pixels.data(); p != pixels.data() + pixels.size(); p += image_->channels())
        for (const int c : channels_) *out++ = inverted_ ? 1.0f - p[c] : p[c];
    });
  }

 private:
  const ImagePtr image_;
  const std::vector<int> channels_;
  const bool inverted_;
};

}  // namespace

ImagePtr held_or_read(ImageInfo info, std::shared_ptr<const PixelSource> source) {
  const auto count = size_t(info.size.area()) * size_t(info.channels);
  if (!PixelRoom::has(count * sizeof(float))) return image_of_source(std::move(info), std::move(source));
  std::vector<float> out(count);
  source->read(whole(info.size), out.data());
  return Image::from_floats(std::move(info), std::move(out));
}

ImagePtr chosen_channels(const ImagePtr& image, ImageInfo info, const std::vector<int>& channels, bool inverted) {
  info.channels = int(channels.size());
  return held_or_read(std::move(info), std::make_shared<ChosenChannels>(image, channels, inverted));
}

}  // namespace terrazzo
