#include <algorithm>
#include <cerrno>
#include <cmath>

#include <Imath/half.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <fmt/format.h>

#include "core/error.h"
#include "core/file_facts.h"
#include "core/file_io.h"
#include "core/image_file.h"

namespace terrazzo {

namespace {

OIIO::TypeDesc type_of_depth(Depth depth) {
  switch (depth) {
    case Depth::u8:
      return OIIO::TypeDesc::UINT8;
    case Depth::u16:
      return OIIO::TypeDesc::UINT16;
    case Depth::f16:
      return OIIO::TypeDesc::HALF;
    case Depth::f32:
      return OIIO::TypeDesc::FLOAT;
  }
  return OIIO::TypeDesc::FLOAT;
}

int written_channels(const Image& image, FileFormat format) {
  const bool has_alpha = image.channels() % 2 == 0;
  return format == FileFormat::jpeg && has_alpha ? image.channels() - 1 : image.channels();
}

OIIO::ImageSpec make_spec(const Image& image, const WriteOptions& options) {
  const ImageInfo& info = image.info();
  OIIO::ImageSpec spec(image.width(), image.height(), written_channels(image, options.format),
                       type_of_depth(options.depth));
  const bool has_alpha = spec.nchannels % 2 == 0 && info.semantic != Semantic::data;
  spec.alpha_channel = has_alpha ? spec.nchannels - 1 : -1;
  if (spec.nchannels == 2)
    spec.channelnames = has_alpha ? std::vector<std::string>{"Y", "A"} : std::vector<std::string>{"R", "G"};
  spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.attribute("DateTime", "1970:01:01 00:00:00");  // else the library writes the time of day
  if (info.color_space == "srgb_texture") spec.attribute("oiio:ColorSpace", "sRGB");
  if (info.color_space == "lin_rec709") spec.attribute("oiio:ColorSpace", "Linear");
  if (info.color_space == "acescg" && options.format == FileFormat::exr) {
    const float ap1[8] = {0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f};
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), ap1);
  }
  if (!options.description.empty()) spec.attribute("ImageDescription", options.description);
  switch (options.format) {
    case FileFormat::png:
      // For photographs level 1 takes half the time of level 6 and gives files of the same size.
      spec.attribute("png:compressionLevel", 1);
      break;
    case FileFormat::tiff:
      spec.attribute("compression", "zip");
      spec.attribute("tiff:half", 1);
      break;
    case FileFormat::exr:
      // Both are lossless; on halfs PIZ takes a quarter of zip's time and two thirds of its bytes.
      spec.attribute("compression", options.depth == Depth::f16 ? "piz" : "zip");
      break;
    case FileFormat::jpeg:
      spec.attribute("Compression", fmt::format("jpeg:{}", options.jpeg_quality));
      spec.attribute("jpeg:subsampling", "4:4:4");
      break;
  }
  return spec;
}

/// Floats as the file's values; counts those that were clipped.
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
  int64_t clipped() const { return clipped_; }

 private:
  template <typename T, typename Convert>
  const void* fill(std::vector<T>& out, const float* in, int64_t pixels, Convert convert) {
    out.resize(size_t(pixels) * out_channels_);
    for (int64_t i = 0; i < pixels; i++)
      for (int c = 0; c < out_channels_; c++) out[i * out_channels_ + c] = convert(in[i * in_channels_ + c]);
    return out.data();
  }
  /// k / scale gives k back, for every k.
  float rounded(float v, float scale) {
    if (v >= 0.0f && v <= 1.0f) return v * scale + 0.5f;
    clipped_++;
    return v > 1.0f ? scale : 0.0f;
  }

  int in_channels_, out_channels_;
  int64_t clipped_ = 0;
  std::vector<uint8_t> bytes_;
  std::vector<uint16_t> words_;
  std::vector<float> floats_;
};

/// The file that an image library writes to. The libraries lose what the operating system says (a PNG on a full disk
/// counts as written), so it is kept here.
class WrittenFile final : public OIIO::Filesystem::IOProxy {
 public:
  explicit WrittenFile(const std::filesystem::path& path)
      : IOProxy(path.string(), Write), path_(path), file_(File::open(path, O_WRONLY | O_CREAT | O_TRUNC)) {
    if (!file_.ok()) throw_system_error("write", path, errno);
  }
  /// Not "file", which the library takes for its own class.
  const char* proxytype() const override { return "written file"; }
  size_t write(const void* data, size_t size) override {
    const size_t written = pwrite(data, size, m_pos);
    m_pos += int64_t(written);
    return written;
  }
  size_t pwrite(const void* data, size_t size, int64_t offset) override {
    try {
      file_.write_at(uint64_t(offset), data, size, path_);
    } catch (const FileError& e) {
      failure_ = e.code();
      return 0;
    }
    size_ = std::max(size_, size_t(offset) + size);
    return size;
  }
  size_t size() const override { return size_; }

  /// Throws what the operating system said, if it refused anything.
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
  size_t size_ = 0;
  int failure_ = 0;
};

using Fail = std::function<void(const std::string& reason)>;

/// Writes to `proxy`, or to the file `name` if there is none; `fail` throws. Returns how many values were clipped.
int64_t write_through(const Image& image, const std::string& name, OIIO::Filesystem::IOProxy* proxy,
                      const WriteOptions& options, const std::function<void(double)>& progress, const Fail& fail) {
  constexpr std::array<const char*, 4> names = {"png", "tiff", "openexr", "jpeg"};
  const auto out = OIIO::ImageOutput::create(names[static_cast<size_t>(options.format)]);
  if (!out) fail(OIIO::geterror());
  out->threads(1);
  if (proxy) out->set_ioproxy(proxy);
  const OIIO::ImageSpec spec = make_spec(image, options);
  if (!out->open(name, spec)) fail(out->geterror());
  Converter converter(image.channels(), spec.nchannels);
  for_each_strip(image, [&](const Rect& r, const float* pixels) {
    const void* values = converter.convert(pixels, r.area(), options.depth);
    if (!out->write_scanlines(r.y, r.bottom(), 0, type_of_depth(options.depth), values)) fail(out->geterror());
    progress(double(r.bottom()) / image.height());
  });
  if (!out->close()) fail(out->geterror());
  return converter.clipped();
}

void require_depth(const WriteOptions& options, const Fail& fail) {
  if (!holds(options.format, options.depth))
    fail(fmt::format("{} cannot hold {} values", name_of(options.format), name_of(options.depth)));
}

}  // namespace

int64_t write_image(const Image& image, const std::filesystem::path& path, const WriteOptions& options,
                    const std::function<void(double)>& progress) {
  const Fail refuse = [&](const std::string& reason) {
    throw Error(fmt::format("cannot write {}: {}", path.string(), reason));
  };
  require_depth(options, refuse);
  WrittenFile file(path);
  const Fail fail = [&](const std::string& reason) {
    file.check();
    refuse(reason);
  };
  // TIFF's library finishes half-float files by ways of its own, so it gets no proxy; what it wrote is checked below.
  const bool is_tiff = options.format == FileFormat::tiff;
  const int64_t clipped = write_through(image, path.string(), is_tiff ? nullptr : &file, options, progress, fail);
  file.close_and_check();
  if (is_tiff && !tiff_is_complete(path)) refuse("not all of it could be written; is the disk full?");
  return clipped;
}

std::vector<uint8_t> png_of(const Image& image) {
  std::vector<uint8_t> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const Fail fail = [](const std::string& reason) { throw Error("cannot make a PNG: " + reason); };
  const WriteOptions options{.format = FileFormat::png, .depth = Depth::u8};
  write_through(
      image, "picture.png", &memory, options, [](double) {}, fail);
  return bytes;
}

}  // namespace terrazzo
