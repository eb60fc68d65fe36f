#include <algorithm>
#include <cerrno>
#include <cmath>
#include <new>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/base/suggest.h"
#include "core/base/text.h"
#include "core/base/tuning.h"
#include "core/file/file_integrity.h"
#include "core/file/file_io.h"
#include "core/image/image_file.h"
#include "core/image/image_libraries.h"
#include "core/image/image_limits.h"
#include "core/image/png_codec.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

struct Tuning {
  double clearly_negative = -0.01;
};
const Tunable<Tuning> tuning("image_read",
                             {
                                 {&Tuning::clearly_negative, "clearly_negative", "of the range of values",
                                  "below which normals are taken for signed numbers. Higher: encoded ones that were "
                                  "filtered are taken for them; lower: nearly flat ones are not",
                                  "not measured: what filters undershoot zero by is no sign", -1, 0},
                             });

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
  throw Error(fmt::format("cannot read {}: {}", path.string(), reason));
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  return text.empty() ? "the image library gives no reason" : text;
}

/// An open file whose header has been found good.
struct OpenFile {
  std::unique_ptr<ImageDecoder> in;

  const StoredImage& header() const { return in->header(); }
  int channels() const { return int(header().channels.size()); }
  bool is_turned() const { return header().orientation >= 5; }
  Size upright() const {
    const Size size = header().size;
    return is_turned() ? Size{size.height, size.width} : size;
  }
};

std::unique_ptr<ImageDecoder> decoder_of(const fs::path& path) {
  try {
    if (std::unique_ptr<ImageDecoder> png = open_png(path)) return png;
    return image_libraries().open_image(path.string());
  } catch (const Error& e) {
    fail(path, one_line(e.what()));
  }
}

void refuse_absurd_sizes(const fs::path& path, const StoredImage& header) {
  const int channels = int(header.channels.size());
  constexpr int64_t most_values = int64_t{1} << 31;
  const auto too_many = [&](int width, int height) {
    return int64_t{width} > most_values / std::max(1, height) / std::max(1, channels);
  };
  const Rect& stored = header.stored;
  if (stored.empty() || header.size.width <= 0 || header.size.height <= 0)
    fail(path, fmt::format("its header says {}x{} pixels", stored.width, stored.height));
  if (too_many(header.size.width, header.size.height) || too_many(stored.width, stored.height))
    fail(path, fmt::format("its header says {}x{} pixels of {}; at most 2^31 values can be read", stored.width,
                           stored.height, counted(channels, "channel")));
  require_pixels_fit(path, header.size, channels);
  require_pixels_fit(path, {stored.width, stored.height}, channels);
}

/// "albedo", "normal"; the one of channels without a prefix is not shown.
std::string listed(const std::vector<std::string>& layers) {
  std::vector<std::string> names;
  for (const std::string& l : layers)
    if (!l.empty()) names.push_back(fmt::format("\"{}\"", l));
  return fmt::format("{}", fmt::join(names, ", "));
}

size_t index_of_layer(const fs::path& path, const std::vector<std::string>& layers, const std::string& wanted) {
  if (wanted.empty() && layers.size() == 1) return 0;
  for (size_t i = 0; i < layers.size(); i++)
    if (lowercase(layers[i]) == lowercase(wanted)) return i;
  if (wanted.empty()) fail(path, fmt::format("it holds the layers {}; say which is meant", listed(layers)));
  const std::string held = listed(layers);
  fail(path, fmt::format("it has no layer \"{}\"{}; it holds {}", wanted, did_you_mean(wanted, layers),
                         held.empty() ? "no named layers" : held));
}

void require_flat_picture(const fs::path& path, const OpenFile& file) {
  const StoredImage& header = file.header();
  refuse_absurd_sizes(path, header);
  if (header.slices > 1) fail(path, fmt::format("it is a volume of {} slices; expected a flat picture", header.slices));
  if (header.deep) fail(path, "it is a deep image (several samples per pixel); expected a flat one");
  if (header.inks || (header.format == "jpeg" && read_jpeg_facts(path, false).components == 4))
    fail(path,
         "it is CMYK, which has no colours without a printing profile; convert it to RGB in an image editor first");
  // The library reads some of these as zeros.
  if (header.type == "double" && header.format == "tiff")
    fail(path, "its values are 64-bit floats; expected at most 32 bits: save it as 32-bit float");
  if (file.channels() < 1 || file.channels() > 4)
    fail(path, fmt::format("it has {} channels ({}); expected 1 to 4: save the wanted ones as a separate file",
                           file.channels(), fmt::join(header.channels, ", ")));
}

OpenFile open(const fs::path& path, const std::string& layer) {
  require_image_file(path);
  OpenFile file{decoder_of(path)};
  if (const std::vector<std::string> layers = file.in->layers(); layers.size() > 1 || !layer.empty())
    file.in->select(index_of_layer(path, layers, layer));
  require_flat_picture(path, file);
  return file;
}

[[noreturn]] void fail_cut_off(const fs::path& path) {
  fail(path, "it is truncated: the end of the image is missing");
}

/// The image library makes up what is missing of JPEG and TIFF files.
void require_complete(const fs::path& path, const OpenFile& file) {
  const std::string_view format = file.header().format;
  if ((format == "jpeg" && !read_jpeg_facts(path).complete) || (format == "tiff" && !tiff_is_complete(path)) ||
      (format == "png" && !png_is_complete(path)))
    fail_cut_off(path);
  if (format == "tiff" && !tiff_is_sound(path))
    fail(path, "it is damaged: a checksum in it does not fit; get the file again from where it came");
}

/// The stored pixels in the depth asked for.
template <typename T>
std::vector<T> read_stored(const fs::path& path, const OpenFile& file, Depth as) {
  require_complete(path, file);
  std::vector<T> out(size_t(file.header().stored.area()) * file.channels());
  try {
    file.in->read(as, out.data());
  } catch (const Error& e) {
    fail(path, "it is damaged or cut off: " + one_line(e.what()));
  }
  return out;
}

/// Puts the stored pixels where they belong in the upright image; what is not stored is 0.
template <typename T>
std::vector<T> placed(const OpenFile& file, std::vector<T> stored) {
  const Rect from = file.header().stored, all = whole(file.header().size);
  const int orientation = file.header().orientation;
  if (from == all && orientation == 1) return stored;
  const int channels = file.channels();
  const Size to = file.upright();
  std::vector<T> out(size_t(to.area()) * channels);
  const Rect visible = intersect(from, all);
  const bool mirror_x = orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7;
  const bool mirror_y = orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
  for (int y = visible.y; y < visible.bottom(); y++)
    for (int x = visible.x; x < visible.right(); x++) {
      int tx = file.is_turned() ? y : x, ty = file.is_turned() ? x : y;
      if (mirror_x) tx = to.width - 1 - tx;
      if (mirror_y) ty = to.height - 1 - ty;
      const size_t at = (size_t(y - from.y) * from.width + (x - from.x)) * channels;
      std::copy_n(&stored[at], channels, &out[(size_t(ty) * to.width + tx) * channels]);
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
    warn(fmt::format("{}{}: {} not finite (NaN or infinite); set to 0", warning_mark, path.filename().string(),
                     count == 1 ? "1 value is" : fmt::format("{} values are", count)));
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
  const auto clearly_negative = float(tuning->clearly_negative);
  if (std::none_of(values.begin(), values.end(), [clearly_negative](float v) { return v < clearly_negative; })) return;
  for (float& v : values) v = v * 0.5f + 0.5f;
  warn(fmt::format("{}: its normals are stored as signed numbers; they were encoded as n * 0.5 + 0.5",
                   path.filename().string()));
}

void warn_of_layout(const fs::path& path, OpenFile& file, const Warn& warn) {
  const std::string name = path.filename().string();
  const StoredImage& header = file.header();
  if (!header.exact) warn(fmt::format("{}: values of type {} are converted to 32-bit floats", name, header.type));
  if (header.stored != whole(header.size))
    warn(
        fmt::format("{}: its data window is not its display window; the display window of {}x{} pixels was read, black "
                    "where there is no data",
                    name, header.size.width, header.size.height));
  if (header.orientation != 1)
    warn(fmt::format("{}: rotated upright, as its orientation tag ({}) says", name, header.orientation));
  if (file.in->has_more_images()) warn(fmt::format("{}: it holds several images; the first was read", name));
}

/// Nothing was asked for, and the file holds more than was read.
void warn_of_layers(const fs::path& path, const OpenFile& file, const std::string& layer, const Warn& warn) {
  const std::vector<std::string> layers = file.in->layers();
  if (layer.empty() && layers.size() > 1)
    warn(fmt::format("{}: its channels without a layer were read; it also holds {}", path.filename().string(),
                     listed(layers)));
}

ImagePtr read_opened(const fs::path& path, OpenFile& file, const ImageInfo& given, const Warn& warn) {
  ImageInfo info = given;
  info.size = file.upright();
  info.channels = file.channels();
  info.depth = file.header().depth;
  warn_of_layout(path, file, warn);
  const bool is_normal = info.semantic == Semantic::normal;
  if (info.depth == Depth::u8)
    return Image::from_floats(info, placed(file, as_fractions(read_stored<uint8_t>(path, file, Depth::u8))));
  if (info.depth == Depth::u16)
    return Image::from_floats(info, placed(file, as_fractions(read_stored<uint16_t>(path, file, Depth::u16))));
  if (info.depth == Depth::f16 && !is_normal) {
    std::vector<uint16_t> halfs = placed(file, read_stored<uint16_t>(path, file, Depth::f16));
    warn_of_zeroed(path, zero_unfinite(halfs), warn);
    return Image::from_halfs(info, std::move(halfs));
  }
  std::vector<float> floats = placed(file, read_stored<float>(path, file, Depth::f32));
  warn_of_zeroed(path, zero_unfinite(floats), warn);
  if (is_normal) encode_signed_normals(path, floats, warn);
  return Image::from_floats(info, std::move(floats));
}

FileInfo info_of(const OpenFile& file, const std::string& layer) {
  return {file.upright(), file.channels(), file.header().depth, file.header().description, layer};
}

}  // namespace

void require_image_file(const fs::path& path) {
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (const std::string kind = irregular_kind(status.type()); !kind.empty())
    fail(path, fmt::format("it is {}; expected an image file", kind));
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

void require_readable_image(const fs::path& path) {
  require_image_file(path);
  if (!seems_complete(path)) fail_cut_off(path);
  const auto is_plain_png = [&] {
    try {
      return open_png(path) != nullptr;
    } catch (const Error& e) {
      fail(path, one_line(e.what()));
    }
  };
  if (!is_plain_png()) require_image_libraries();
}

FileInfo read_image_info(const fs::path& path, const std::string& layer) {
  require_image_file(path);
  // Such a file needs no decoder to be known.
  const JpegFacts jpeg = read_jpeg_facts(path, false);
  if (layer.empty() && (jpeg.components == 1 || jpeg.components == 3) && jpeg.bits == 8 && jpeg.size.area() > 0 &&
      !jpeg.has_exif) {
    require_pixels_fit(path, jpeg.size, jpeg.components);
    return {jpeg.size, jpeg.components, Depth::u8};
  }
  return info_of(open(path, layer), layer);
}

std::vector<FileInfo> read_layer_infos(const fs::path& path) {
  if (lowercase(path.extension().string()) != ".exr") return {read_image_info(path)};
  require_image_file(path);
  const OpenFile file{decoder_of(path)};
  const std::vector<std::string> layers = file.in->layers();
  if (layers.size() == 1) require_flat_picture(path, file);  // of several, reading one says what is wrong with it
  std::vector<FileInfo> infos;
  for (size_t i = 0; i < layers.size(); i++) {
    file.in->select(i);
    infos.push_back(info_of(file, layers[i]));
  }
  return infos;
}

ImagePtr read_image(const fs::path& path, const ImageInfo& info, const Warn& warn, const std::string& layer) {
  OpenFile file = open(path, layer);
  warn_of_layers(path, file, layer, warn);
  try {
    return read_opened(path, file, info, warn);
  } catch (const std::bad_alloc&) {
    fail(path, fmt::format("{}x{} pixels of {} do not fit in memory", file.header().size.width,
                           file.header().size.height, counted(file.channels(), "channel")));
  }
}

}  // namespace terrazzo
