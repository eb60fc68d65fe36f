#include <algorithm>
#include <cerrno>
#include <cmath>

#include <Imath/half.h>
#include <fcntl.h>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/file/file_io.h"
#include "core/image_io/image_file.h"
#include "core/image_io/image_libraries.h"
#include "core/image_io/png_codec.h"
#include "core/integrity/file_integrity.h"

namespace terrazzo {

namespace {

EncodedImage encoded(const Image& image, const WriteOptions& options) {
  const bool even = image.channels() % 2 == 0, is_jpeg = options.format == FileFormat::jpeg;
  EncodedImage out{.size = image.size(), .channels = image.channels(), .options = options};
  if (is_jpeg && even) out.channels--;
  out.has_alpha = even && !is_jpeg && image.info().semantic != Semantic::data;
  out.color_space = image.info().color_space;
  return out;
}

/// Converts floats to the file's values and counts clipped ones.
class Converter {
 public:
  Converter(int in_channels, int out_channels) : in_channels_(in_channels), out_channels_(out_channels) {}

  const void* convert(const float* in, int64_t pixels, Depth depth) {
    switch (depth) {
      case Depth::u8:
        return fill(bytes_, in, pixels, [this](float v) { return uint8_t(rounded(v, 255.0f)); });
      case Depth::u16:
        return fill(words_, in, pixels, [this](float v) { return uint16_t(rounded(v, 65535.0f)); });
      case Depth::f16:
        return fill(words_, in, pixels, [](float v) {
          constexpr float largest_half = 65504.0f;
          return imath_float_to_half(std::clamp(v, -largest_half, largest_half));
        });
      case Depth::f32:
        return fill(floats_, in, pixels, [](float v) { return v; });
    }
    return nullptr;
  }
  const Clipping& clipped() const { return clipped_; }

 private:
  template <typename T, typename Convert>
  const void* fill(std::vector<T>& out, const float* in, int64_t pixels, Convert convert) {
    out.resize(size_t(pixels) * out_channels_);
    clipped_.all += int64_t(out.size());
    for (int64_t i = 0; i < pixels; i++)
      for (int c = 0; c < out_channels_; c++) out[i * out_channels_ + c] = convert(in[i * in_channels_ + c]);
    return out.data();
  }
  /// k / scale gives k back, for every k.
  float rounded(float v, float scale) {
    if (v >= 0.0f && v <= 1.0f) return v * scale + 0.5f;
    clipped_.least = clipped_.values ? std::min(clipped_.least, v) : v;
    clipped_.most = clipped_.values ? std::max(clipped_.most, v) : v;
    clipped_.values++;
    return v > 1.0f ? scale : 0.0f;
  }

  int in_channels_, out_channels_;
  Clipping clipped_;
  std::vector<uint8_t> bytes_;
  std::vector<uint16_t> words_;
  std::vector<float> floats_;
};

/// The output file of an image library. The libraries drop errors of the operating system (a PNG on a full disk counts
/// as written), so they are recorded here.
class WrittenFile final : public ByteSink {
 public:
  explicit WrittenFile(const std::filesystem::path& path)
      : path_(path), file_(File::open(path, O_WRONLY | O_CREAT | O_TRUNC)) {
    if (!file_.ok()) throw_system_error("write", path, errno);
  }
  bool write(uint64_t offset, const void* data, size_t size) override {
    try {
      file_.write_at(offset, data, size, path_);
      return true;
    } catch (const FileError& e) {
      failure_ = e.code();
      return false;
    }
  }
  /// Throws the recorded operating system error, if any.
  void check() const {
    if (failure_ != 0) throw_system_error("write", path_, failure_);
  }
  void close_and_check() {
    check();
    file_.close(path_);
  }

 private:
  std::filesystem::path path_;
  File file_;
  int failure_ = 0;
};

class WrittenBytes final : public ByteSink {
 public:
  bool write(uint64_t offset, const void* data, size_t size) override {
    bytes.resize(std::max(bytes.size(), size_t(offset) + size));
    std::copy_n(static_cast<const uint8_t*>(data), size, bytes.begin() + ptrdiff_t(offset));
    return true;
  }
  std::vector<uint8_t> bytes;
};

using Fail = std::function<void(const std::string& reason)>;

/// Writes to `sink`, or to the file `name` if there is none. Calls `fail` with the encoder's error, which throws.
/// Returns the clipping.
Clipping write_through(const Image& image, const std::string& name, ByteSink* sink, const WriteOptions& options,
                       const std::function<void(double)>& progress, const Fail& fail) {
  const EncodedImage target = encoded(image, options);
  std::unique_ptr<ImageEncoder> out;
  const auto encode = [&](const auto& step) {
    try {
      step();
    } catch (const Error& e) {
      fail(e.what());
    }
  };
  encode([&] {
    const bool is_png = options.format == FileFormat::png && sink;
    out = is_png ? create_png(target, *sink) : image_libraries().create_image(name, target, sink);
  });
  Converter converter(image.channels(), target.channels);
  const auto write_level = [&](const Image& level, const std::function<void(double)>& tell) {
    for_each_strip(level, [&](const Rect& r, const float* pixels) {
      const void* values = converter.convert(pixels, r.area(), options.depth);
      encode([&] { out->write_rows(r.y, r.bottom(), values); });
      tell(double(r.bottom()) / level.height());
    });
  };
  write_level(image, progress);
  for (const ImagePtr& level : options.levels) {
    encode([&] { out->next_level(level->size()); });
    write_level(*level, [](double) {});
  }
  encode([&] { out->finish(); });
  return converter.clipped();
}

}  // namespace

Clipping write_image(const Image& image, const std::filesystem::path& path, const WriteOptions& options,
                     const std::function<void(double)>& progress) {
  const Fail refuse = [&](const std::string& reason) {
    throw Error(fmt::format("cannot write {}: {}", path.string(), reason));
  };
  if (!holds(options.format, options.depth))
    refuse(fmt::format("{} cannot hold {} values", name_of(options.format), name_of(options.depth)));
  WrittenFile file(path);
  const Fail fail = [&](const std::string& reason) {
    file.check();
    refuse(reason);
  };
  // libtiff finishes half-float files without the proxy, so it gets none; its file is checked below.
  const bool is_tiff = options.format == FileFormat::tiff || options.format == FileFormat::tx;
  const Clipping clipped = write_through(image, path.string(), is_tiff ? nullptr : &file, options, progress, fail);
  file.close_and_check();
  if (is_tiff && !tiff_is_complete(path)) refuse("not all of it could be written; is the disk full?");
  return clipped;
}

std::vector<uint8_t> encoded_file(const Image& image, const WriteOptions& options) {
  WrittenBytes memory;
  const std::string format(name_of(options.format));
  const Fail fail = [&](const std::string& reason) { throw Error(fmt::format("cannot make {}: {}", format, reason)); };
  write_through(
      image, "picture." + format, &memory, options, [](double) {}, fail);
  return std::move(memory.bytes);
}

}  // namespace terrazzo
