#include "core/image_file.h"

#include <algorithm>

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "core/error.h"

namespace terrazzo {

namespace {

Depth depth_of(OIIO::TypeDesc format) {
  if (format == OIIO::TypeDesc::HALF) return Depth::f16;
  if (format == OIIO::TypeDesc::UINT8) return Depth::u8;
  if (format == OIIO::TypeDesc::UINT16) return Depth::u16;
  return Depth::f32;
}

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

std::unique_ptr<OIIO::ImageInput> open(const std::filesystem::path& path) {
  auto in = OIIO::ImageInput::open(path.string());
  if (!in) throw Error(fmt::format("cannot read {}: {}", path.string(), OIIO::geterror()));
  return in;
}

}  // namespace

bool looks_like_image(const std::filesystem::path& path) {
  static const std::vector<std::string> known = {".png", ".jpg", ".jpeg", ".tif", ".tiff",
                                                 ".exr", ".tga", ".bmp",  ".hdr"};
  std::string e = path.extension().string();
  std::transform(e.begin(), e.end(), e.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::find(known.begin(), known.end(), e) != known.end();
}

FileInfo read_image_info(const std::filesystem::path& path) {
  const auto in = open(path);
  const OIIO::ImageSpec& spec = in->spec();
  return {{spec.width, spec.height}, spec.nchannels, depth_of(spec.format), ""};
}

ImagePtr read_image(const std::filesystem::path& path, const ImageInfo& given,
                    const std::function<void(const std::string&)>&) {
  const auto in = open(path);
  const OIIO::ImageSpec& spec = in->spec();
  ImageInfo info = given;
  info.size = {spec.width, spec.height};
  info.channels = std::min(4, spec.nchannels);
  info.depth = depth_of(spec.format);
  std::vector<float> pixels(size_t(info.size.area()) * info.channels);
  if (!in->read_image(0, 0, 0, info.channels, OIIO::TypeDesc::FLOAT, pixels.data()))
    throw Error(fmt::format("cannot read {}: {}", path.string(), in->geterror()));
  return Image::from_floats(info, std::move(pixels));
}

bool holds(FileFormat format, Depth depth) {
  switch (format) {
    case FileFormat::png:
      return depth == Depth::u8 || depth == Depth::u16;
    case FileFormat::tiff:
      return true;
    case FileFormat::exr:
      return depth == Depth::f16 || depth == Depth::f32;
    case FileFormat::jpeg:
      return depth == Depth::u8;
  }
  return false;
}

std::optional<FileFormat> format_from(const std::filesystem::path& path) {
  const std::string e = path.extension().string();
  if (e == ".png") return FileFormat::png;
  if (e == ".tif" || e == ".tiff") return FileFormat::tiff;
  if (e == ".exr") return FileFormat::exr;
  if (e == ".jpg" || e == ".jpeg") return FileFormat::jpeg;
  return std::nullopt;
}

void write_image(const Image& image, const std::filesystem::path& path, const WriteOptions& options,
                 const std::function<void(double)>& progress) {
  auto out = OIIO::ImageOutput::create(path.string());
  if (!out) throw Error(fmt::format("cannot write {}: {}", path.string(), OIIO::geterror()));
  OIIO::ImageSpec spec(image.width(), image.height(), image.channels(), type_of_depth(options.depth));
  if (!out->open(path.string(), spec)) throw Error(fmt::format("cannot write {}: {}", path.string(), out->geterror()));
  for_each_strip(image, [&](const Rect& r, const float* pixels) {
    if (!out->write_scanlines(r.y, r.bottom(), 0, OIIO::TypeDesc::FLOAT, pixels))
      throw Error(fmt::format("cannot write {}: {}", path.string(), out->geterror()));
    progress(double(r.bottom()) / image.height());
  });
  if (!out->close()) throw Error(fmt::format("cannot write {}: {}", path.string(), out->geterror()));
}

}  // namespace terrazzo
