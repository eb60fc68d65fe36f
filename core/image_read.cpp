#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <new>

#include <Imath/half.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "core/error.h"
#include "core/file_facts.h"
#include "core/file_io.h"
#include "core/image_file.h"
#include "core/suggest.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
  throw Error(fmt::format("cannot read {}: {}", path.string(), reason));
}

Depth depth_of(const OIIO::ImageSpec& spec) {
  if (!spec.channelformats.empty()) return Depth::f32;  // channels of different depths
  if (spec.format == OIIO::TypeDesc::HALF) return Depth::f16;
  if (spec.format == OIIO::TypeDesc::UINT8) return Depth::u8;
  if (spec.format == OIIO::TypeDesc::UINT16) return Depth::u16;
  return Depth::f32;
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  return text.empty() ? "the image library gives no reason" : text;
}

/// An open file whose header has been found good.
struct OpenFile {
  std::unique_ptr<OIIO::ImageInput> in;
  Rect stored;          ///< the pixels that are stored, in the image's coordinates
  Size size;            ///< of the image as stored, before it is turned
  int orientation = 1;  ///< as in EXIF
  Depth depth = Depth::u8;

  const OIIO::ImageSpec& spec() const { return in->spec(); }
  bool is_turned() const { return orientation >= 5; }
  Size upright() const { return is_turned() ? Size{size.height, size.width} : size; }
};

void refuse_ink(const fs::path& path, const OpenFile& file) {
  const std::string format = file.in->format_name();
  const bool is_cmyk = (format == "jpeg" && read_jpeg_facts(path).components == 4) ||
                       file.spec().get_string_attribute("tiff:ColorSpace") == "CMYK" ||
                       file.spec().get_int_attribute("tiff:PhotometricInterpretation", -1) == 5 ||
                       file.spec().get_string_attribute("oiio:ColorSpace") == "CMYK";
  if (is_cmyk)
    fail(path,
         "its colours are printing inks (CMYK), which mean nothing without a printing profile; convert it to RGB in an "
         "image editor first");
}

OpenFile open(const fs::path& path) {
  require_image_file(path);
  OIIO::ImageSpec wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);
  OpenFile file;
  file.in = OIIO::ImageInput::open(path.string(), &wishes);
  if (!file.in) fail(path, one_line(OIIO::geterror()));
  file.in->threads(1);
  const OIIO::ImageSpec& spec = file.spec();
  file.stored = {0, 0, spec.width, spec.height};
  file.size = {spec.width, spec.height};
  if (std::string_view(file.in->format_name()) == "openexr") {
    file.stored = {spec.x - spec.full_x, spec.y - spec.full_y, spec.width, spec.height};
    file.size = {spec.full_width, spec.full_height};
  }
  file.orientation = std::clamp(spec.get_int_attribute("Orientation", 1), 1, 8);
  file.depth = depth_of(spec);

  constexpr int64_t most_values = int64_t{1} << 31;
  const auto too_many = [&](Size s) {
    return int64_t{s.width} > most_values / std::max(1, s.height) / std::max(1, spec.nchannels);
  };
  if (spec.width <= 0 || spec.height <= 0 || file.size.width <= 0 || file.size.height <= 0)
    fail(path, fmt::format("its header says {}x{} pixels", spec.width, spec.height));
  if (too_many(file.size) || too_many({spec.width, spec.height}))
    fail(path, fmt::format("its header says {}x{} pixels of {} channels; at most 2^31 values can be read", spec.width,
                           spec.height, spec.nchannels));
  if (spec.depth > 1) fail(path, fmt::format("it is a volume of {} slices; expected a flat picture", spec.depth));
  if (spec.deep) fail(path, "it is a deep image (several samples per pixel); expected a flat one");
  refuse_ink(path, file);
  // The library reads some of these as zeros.
  if (spec.format == OIIO::TypeDesc::DOUBLE && std::string_view(file.in->format_name()) == "tiff")
    fail(path, "its values are 64-bit floats; expected at most 32 bits: save it as 32-bit float");
  if (spec.nchannels < 1 || spec.nchannels > 4)
    fail(path, fmt::format("it has {} channels ({}); expected 1 to 4: write the wanted ones to a file of their own",
                           spec.nchannels, fmt::join(spec.channelnames, ", ")));
  return file;
}

/// The image library makes up what is missing of these formats.
void require_complete(const fs::path& path, const OpenFile& file) {
  const std::string_view format = file.in->format_name();
  if ((format == "jpeg" && !read_jpeg_facts(path).complete) || (format == "tiff" && !tiff_is_complete(path)))
    fail(path, "it is cut off: the end of the image is missing");
}

/// The stored pixels in the type asked for.
template <typename T>
std::vector<T> read_stored(const fs::path& path, const OpenFile& file, OIIO::TypeDesc type) {
  require_complete(path, file);
  std::vector<T> out(size_t(file.stored.area()) * file.spec().nchannels);
  if (!file.in->read_image(0, 0, 0, file.spec().nchannels, type, out.data()))
    fail(path, "it is damaged or cut off: " + one_line(file.in->geterror()));
  return out;
}

/// Puts the stored pixels where they belong in the upright image; what is not stored is 0.
template <typename T>
std::vector<T> placed(const OpenFile& file, std::vector<T> stored) {
  const Rect all = whole(file.size);
  if (file.stored == all && file.orientation == 1) return stored;
  const int channels = file.spec().nchannels;
  const Size to = file.upright();
  std::vector<T> out(size_t(to.area()) * channels);
  const Rect visible = intersect(file.stored, all);
  const bool mirror_x =
      file.orientation == 2 || file.orientation == 3 || file.orientation == 6 || file.orientation == 7;
  const bool mirror_y =
      file.orientation == 3 || file.orientation == 4 || file.orientation == 7 || file.orientation == 8;
  for (int y = visible.y; y < visible.bottom(); y++)
    for (int x = visible.x; x < visible.right(); x++) {
      int tx = file.is_turned() ? y : x, ty = file.is_turned() ? x : y;
      if (mirror_x) tx = to.width - 1 - tx;
      if (mirror_y) ty = to.height - 1 - ty;
      const size_t from = (size_t(y - file.stored.y) * file.stored.width + (x - file.stored.x)) * channels;
      std::copy_n(&stored[from], channels, &out[(size_t(ty) * to.width + tx) * channels]);
    }
  return out;
}

template <typename T>
std::vector<float> as_fractions(const std::vector<T>& values) {
  constexpr float largest = std::numeric_limits<T>::max();
  std::vector<float> out(values.size());
  for (size_t i = 0; i < values.size(); i++) out[i] = float(values[i]) / largest;
  return out;
}

using Warn = std::function<void(const std::string&)>;

void warn_of_zeroed(const fs::path& path, size_t count, const Warn& warn) {
  if (count)
    warn(fmt::format("{}: {} values are not finite numbers (NaN or infinite); they were set to 0",
                     path.filename().string(), count));
}

size_t zero_unfinite(std::vector<float>& values) {
  size_t count = 0;
  for (float& v : values)
    if (!std::isfinite(v)) {
      v = 0;
      count++;
    }
  return count;
}

size_t zero_unfinite(std::vector<uint16_t>& halfs) {
  constexpr uint16_t exponent = 0x7c00;
  size_t count = 0;
  for (uint16_t& h : halfs)
    if ((h & exponent) == exponent) {
      h = 0;
      count++;
    }
  return count;
}

void encode_signed_normals(const fs::path& path, std::vector<float>& values, const Warn& warn) {
  constexpr float clearly_negative = -0.01f;
  if (std::none_of(values.begin(), values.end(), [](float v) { return v < clearly_negative; })) return;
  for (float& v : values) v = v * 0.5f + 0.5f;
  warn(fmt::format("{}: its normals are stored as signed numbers; they were encoded as n * 0.5 + 0.5",
                   path.filename().string()));
}

void warn_of_layout(const fs::path& path, OpenFile& file, const Warn& warn) {
  const std::string name = path.filename().string();
  const OIIO::TypeDesc format = file.spec().format;
  if (file.depth == Depth::f32 && format != OIIO::TypeDesc::FLOAT)
    warn(fmt::format("{}: values of type {} are kept as 32-bit floats", name,
                     file.spec().channelformats.empty() ? format.c_str() : "mixed depth"));
  if (file.stored != whole(file.size))
    warn(
        fmt::format("{}: its data window is not its display window; the display window of {}x{} pixels was read, black "
                    "where there is no data",
                    name, file.size.width, file.size.height));
  if (file.orientation != 1)
    warn(fmt::format("{}: turned upright, as its orientation mark ({}) says", name, file.orientation));
  if (file.in->seek_subimage(1, 0)) {
    warn(fmt::format("{}: it holds several images; the first was read", name));
    file.in->seek_subimage(0, 0);
  }
}

ImagePtr read_opened(const fs::path& path, OpenFile& file, const ImageInfo& given, const Warn& warn) {
  ImageInfo info = given;
  info.size = file.upright();
  info.channels = file.spec().nchannels;
  info.depth = file.depth;
  warn_of_layout(path, file, warn);
  const bool is_normal = info.semantic == Semantic::normal;
  if (file.depth == Depth::u8)
    return Image::from_floats(info,
                              placed(file, as_fractions(read_stored<uint8_t>(path, file, OIIO::TypeDesc::UINT8))));
  if (file.depth == Depth::u16)
    return Image::from_floats(info,
                              placed(file, as_fractions(read_stored<uint16_t>(path, file, OIIO::TypeDesc::UINT16))));
  if (file.depth == Depth::f16 && !is_normal) {
    std::vector<uint16_t> halfs = placed(file, read_stored<uint16_t>(path, file, OIIO::TypeDesc::HALF));
    warn_of_zeroed(path, zero_unfinite(halfs), warn);
    return Image::from_halfs(info, std::move(halfs));
  }
  std::vector<float> floats = placed(file, read_stored<float>(path, file, OIIO::TypeDesc::FLOAT));
  warn_of_zeroed(path, zero_unfinite(floats), warn);
  if (is_normal) encode_signed_normals(path, floats, warn);
  return Image::from_floats(info, std::move(floats));
}

}  // namespace

void require_image_file(const fs::path& path) {
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (fs::is_directory(status)) fail(path, "it is a folder; expected an image file");
  if (!fs::exists(status) && fs::is_symlink(fs::symlink_status(path, failure)))
    fail(path, fmt::format("it is a link to {}, which does not exist", fs::read_symlink(path, failure).string()));
  if (status.type() == fs::file_type::none) throw_system_error("read", path, failure.value());
  if (!fs::exists(status)) {
    std::vector<std::string> others;
    for (const fs::directory_entry& e : fs::directory_iterator(path.parent_path(), failure))
      others.push_back(e.path().filename().string());
    std::sort(others.begin(), others.end());
    fail(path, "there is no such file" + did_you_mean(path.filename().string(), others));
  }
  if (::access(path.c_str(), R_OK) != 0) throw_system_error("read", path, errno);
  if (fs::file_size(path, failure) == 0) fail(path, "the file is empty (0 bytes)");
}

FileInfo read_image_info(const fs::path& path) {
  const OpenFile file = open(path);
  return {file.upright(), file.spec().nchannels, file.depth};
}

ImagePtr read_image(const fs::path& path, const ImageInfo& info, const Warn& warn) {
  OpenFile file = open(path);
  try {
    return read_opened(path, file, info, warn);
  } catch (const std::bad_alloc&) {
    fail(path, fmt::format("{}x{} pixels of {} channels do not fit in memory", file.size.width, file.size.height,
                           file.spec().nchannels));
  }
}

}  // namespace terrazzo
