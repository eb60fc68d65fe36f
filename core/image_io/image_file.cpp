#include "core/image_io/image_file.h"

#include <algorithm>
#include <array>

#include "core/base/text.h"

namespace terrazzo {

namespace {

std::string lower_extension(const std::filesystem::path& path) {
  return lowercase(path.extension().string());
}

}  // namespace

bool looks_like_image(const std::filesystem::path& path) {
  static const std::vector<std::string> known = {
      ".png", ".jpg",  ".jpeg", ".jpe", ".jfif", ".tif", ".tiff", ".exr", ".tga", ".bmp", ".hdr",
      ".gif", ".webp", ".psd",  ".tx",  ".dds",  ".ppm", ".pgm",  ".pbm", ".pnm", ".pfm", ".jp2",
      ".j2k", ".j2c",  ".sgi",  ".rgb", ".rgba", ".bw",  ".dpx",  ".cin", ".iff", ".rla", ".fits"};
  return std::find(known.begin(), known.end(), lower_extension(path)) != known.end();
}

std::string_view name_of(FileFormat format) {
  constexpr std::array<std::string_view, 6> names = {"PNG", "TIFF", "EXR", "JPEG", "TGA", "TX"};
  return names[static_cast<size_t>(format)];
}

bool holds(FileFormat format, Depth depth) {
  switch (format) {
    case FileFormat::png:
      return depth == Depth::u8 || depth == Depth::u16;
    case FileFormat::tiff:
    case FileFormat::tx:
      return true;
    case FileFormat::exr:
      return depth == Depth::f16 || depth == Depth::f32;
    case FileFormat::jpeg:
    case FileFormat::tga:
      return depth == Depth::u8;
  }
  return false;
}

std::optional<FileFormat> format_from(const std::filesystem::path& path) {
  const std::string e = lower_extension(path);
  if (e == ".png") return FileFormat::png;
  if (e == ".tif" || e == ".tiff") return FileFormat::tiff;
  if (e == ".exr") return FileFormat::exr;
  if (e == ".jpg" || e == ".jpeg") return FileFormat::jpeg;
  if (e == ".tga") return FileFormat::tga;
  if (e == ".tx") return FileFormat::tx;
  return std::nullopt;
}

}  // namespace terrazzo
