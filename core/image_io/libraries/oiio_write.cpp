#include <algorithm>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "core/base/error.h"
#include "core/image_io/libraries/parts.h"

namespace terrazzo {

namespace {

constexpr int tile = 64;  ///< maketx's

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

OIIO::ImageSpec make_spec(const EncodedImage& image) {
  const WriteOptions& options = image.options;
  OIIO::ImageSpec spec(image.size.width, image.size.height, image.channels, type_of_depth(options.depth));
  spec.alpha_channel = image.has_alpha ? spec.nchannels - 1 : -1;
  if (spec.nchannels == 2)
    spec.channelnames = image.has_alpha ? std::vector<std::string>{"Y", "A"} : std::vector<std::string>{"R", "G"};
  spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.attribute("DateTime", "1970:01:01 00:00:00");  // else the library writes the time of day
  if (image.color_space == "srgb_texture") spec.attribute("oiio:ColorSpace", "sRGB");
  if (image.color_space == "lin_rec709") spec.attribute("oiio:ColorSpace", "Linear");
  if (image.color_space == "acescg" && options.format == FileFormat::exr) {
    const float ap1[8] = {0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f};
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), ap1);
  }
  if (!options.description.empty()) spec.attribute("ImageDescription", options.description);
  switch (options.format) {
    case FileFormat::png:
      break;  // see core/image_io/png_codec.h
    case FileFormat::tiff:
      spec.attribute("compression", "zip");
      spec.attribute("tiff:half", 1);
      break;
    case FileFormat::tx:
      spec.attribute("compression", "zip");
      spec.attribute("tiff:half", 1);
      spec.tile_width = spec.tile_height = tile;
      spec.tile_depth = 1;
      // Tells texture systems that further images in the file are its mip levels.
      spec.attribute("textureformat", "Plain Texture");
      spec.attribute("wrapmodes", "periodic,periodic");
      break;
    case FileFormat::exr:
      // PIZ has no checksum: damaged pixels would pass for others (see damage in tests/bench/experiments.md).
      spec.attribute("compression", "zip");
      break;
    case FileFormat::jpeg:
      spec.attribute("Compression", "jpeg:" + std::to_string(options.jpeg_quality));
      spec.attribute("jpeg:subsampling", "4:4:4");
      break;
    case FileFormat::tga:
      spec.attribute("compression", "rle");
      break;
  }
  return spec;
}

/// The sink as the file that the library writes to.
class SinkProxy final : public OIIO::Filesystem::IOProxy {
 public:
  SinkProxy(const std::string& name, ByteSink& sink) : IOProxy(name, Write), sink_(sink) {}
  /// Not "file", which the library takes for its own class.
  const char* proxytype() const override { return "sink"; }
  size_t write(const void* data, size_t size) override {
    const size_t written = pwrite(data, size, m_pos);
    m_pos += int64_t(written);
    return written;
  }
  size_t pwrite(const void* data, size_t size, int64_t offset) override {
    if (!sink_.write(uint64_t(offset), data, size)) return 0;
    size_ = std::max(size_, size_t(offset) + size);
    return size;
  }
  size_t size() const override { return size_; }

 private:
  ByteSink& sink_;
  size_t size_ = 0;
};

class OiioEncoder final : public ImageEncoder {
 public:
  OiioEncoder(const std::string& name, const EncodedImage& image, ByteSink* sink)
      : name_(name), spec_(make_spec(image)) {
    constexpr std::array<const char*, 6> formats = {"png", "tiff", "openexr", "jpeg", "targa", "tiff"};
    out_ = OIIO::ImageOutput::create(formats[static_cast<size_t>(image.options.format)]);
    if (!out_) throw Error(OIIO::geterror());
    out_->threads(1);
    if (sink) {
      proxy_ = std::make_unique<SinkProxy>(name, *sink);
      out_->set_ioproxy(proxy_.get());
    }
    require(out_->open(name, spec_));
  }
  void write_rows(int first, int end, const void* values) override {
    if (spec_.tile_width == 0) return require(out_->write_scanlines(first, end, 0, spec_.format, values));
    const auto* bytes = static_cast<const uint8_t*>(values);
    const size_t row = spec_.scanline_bytes();
    for (int y = first; y < end; y++, bytes += row) {
      tiles_.insert(tiles_.end(), bytes, bytes + row);
      if ((y + 1) % tile == 0 || y + 1 == spec_.height) write_tiles(y + 1);
    }
  }
  void next_level(Size size) override {
    spec_.width = spec_.full_width = size.width;
    spec_.height = spec_.full_height = size.height;
    require(out_->open(name_, spec_, OIIO::ImageOutput::AppendSubimage));
  }
  void finish() override { require(out_->close()); }

 private:
  /// The rows that have been collected, up to `end`.
  void write_tiles(int end) {
    const int begin = end - int(tiles_.size() / spec_.scanline_bytes());
    require(out_->write_tiles(0, spec_.width, begin, end, 0, 1, spec_.format, tiles_.data()));
    tiles_.clear();
  }
  void require(bool done) const {
    if (!done) throw Error(out_->geterror());
  }
  std::string name_;
  OIIO::ImageSpec spec_;
  std::vector<uint8_t> tiles_;  ///< pixel rows of one row of tiles
  std::unique_ptr<SinkProxy> proxy_;
  std::unique_ptr<OIIO::ImageOutput> out_;
};

}  // namespace

std::unique_ptr<ImageEncoder> create_with_oiio(const std::string& name, const EncodedImage& image, ByteSink* sink) {
  return std::make_unique<OiioEncoder>(name, image, sink);
}

}  // namespace terrazzo
