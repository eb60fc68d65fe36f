#include "core/image_io/image_open.h"

#include <algorithm>
#include <cerrno>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/base/suggest.h"
#include "core/base/text.h"
#include "core/file/file_io.h"
#include "core/file/file_stamp.h"
#include "core/file/other_content.h"
#include "core/file/path_spelling.h"
#include "core/image/image_limits.h"
#include "core/image_io/image_file.h"
#include "core/image_io/png_codec.h"
#include "core/image_io/psd_codec.h"
#include "core/image_io/tga_codec.h"
#include "core/integrity/file_integrity.h"

namespace terrazzo {

namespace fs = std::filesystem;

void fail_to_read(const fs::path& path, const std::string& reason) {
  throw Error(fmt::format("cannot read {}: {}", path.string(), reason));
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  constexpr size_t most = 300;  // the library repeats itself if it finds many faults
  if (text.size() > most) text = text.substr(0, most) + " ...";
  return text.empty() ? "the image library gives no reason" : text;
}

std::string described_window(const Rect& window) {
  return fmt::format("{} at ({}, {})", describe(Size{window.width, window.height}), window.x, window.y);
}

std::string listed_layers(const std::vector<std::string>& layers) {
  std::vector<std::string> names;
  for (const std::string& l : layers)
    if (!l.empty()) names.push_back(fmt::format("\"{}\"", l));
  return fmt::format("{}", fmt::join(names, ", "));
}

namespace {

void refuse_other_content(const fs::path& path) {
  const std::string content = other_content(path);
  if (!content.empty())
    fail_to_read(path,
                 fmt::format("it is {}, whatever its name says; save the image as PNG, TIFF, EXR or JPEG", content));
}

std::unique_ptr<ImageDecoder> decoder_of(const fs::path& path) {
  try {
    for (const auto& open : {open_png, open_psd, open_tga_with_alpha_bit})
      if (std::unique_ptr<ImageDecoder> own = open(path)) return own;
    return image_libraries().open_image(path.string());
  } catch (const Error& e) {
    refuse_other_content(path);
    const std::string reason = one_line(e.what());
    if (reason.find("Not a ") == reason.npos && reason.find("not a ") == reason.npos) fail_to_read(path, reason);
    // The image library's message only says which format it is not.
    fail_to_read(path,
                 fmt::format("it is not an image of a known format ({}); save it as PNG, TIFF, EXR or JPEG", reason));
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
    fail_to_read(path, fmt::format("its header says {}x{} pixels", stored.width, stored.height));
  if (too_many(header.size.width, header.size.height) || too_many(stored.width, stored.height))
    fail_to_read(path, fmt::format("its header says {}x{} pixels of {}; at most 2^31 values can be read", stored.width,
                                   stored.height, counted(channels, "channel")));
  require_pixels_fit(path, header.size, channels);
  require_pixels_fit(path, {stored.width, stored.height}, channels);
}

void require_visible_pixels(const fs::path& path, const StoredImage& header) {
  const Rect all = whole(header.size), seen = intersect(header.stored, all);
  if (seen == all) return;
  if (seen.empty())
    fail_to_read(path,
                 fmt::format("its data window, {}, lies wholly outside its display window, {} at (0, 0), so that it "
                             "shows nothing; save it with a display window that holds the data, with OpenImageIO "
                             "by \"oiiotool FILE --fullpixels -o FILE\"",
                             described_window(header.stored), describe(header.size)));
  fail_to_read(path,
               fmt::format("its data window, {}, covers only a part of its display window, {} at (0, 0): {} of {} "
                           "pixels have no data. Crop all maps of the material alike, with OpenImageIO by \"oiiotool "
                           "FILE --cut {}x{}+{}+{} -o FILE\"; or, if it should be 0 there, fill it by \"oiiotool FILE "
                           "--croptofull -o FILE\"",
                           described_window(header.stored), describe(header.size), all.area() - seen.area(), all.area(),
                           seen.width, seen.height, seen.x + header.left, seen.y + header.top));
}

/// Decoders hold all coefficients of a progressive JPEG file.
void require_coefficients_fit(const fs::path& path, Size size, int components) {
  constexpr uint64_t bytes_per_coefficient = 2;
  require_decoding_fits(path, uint64_t(size.area()) * uint64_t(components) * bytes_per_coefficient,
                        "it is a progressive JPEG");
}

/// Decoders hold images that do not come row by row as a whole.
void require_whole_fits(const fs::path& path, const StoredImage& header) {
  const bool is_png = header.format == "png";
  const size_t bytes_per_value = !is_png ? sizeof(float) : header.depth == Depth::u8 ? 1 : 2;
  require_decoding_fits(path, uint64_t(header.stored.area()) * header.channels.size() * bytes_per_value,
                        is_png ? "it is interlaced" : "its format is decoded as a whole");
}

size_t index_of_layer(const fs::path& path, const std::vector<std::string>& layers, const std::string& wanted) {
  if (wanted.empty() && layers.size() == 1) return 0;
  for (size_t i = 0; i < layers.size(); i++)
    if (lowercase(layers[i]) == lowercase(wanted)) return i;
  if (wanted.empty())
    fail_to_read(path, fmt::format("it holds the layers {}; say which is meant", listed_layers(layers)));
  const std::string held = listed_layers(layers);
  fail_to_read(path, fmt::format("it has no layer \"{}\"{}; it holds {}", wanted, did_you_mean(wanted, layers),
                                 held.empty() ? "no named layers" : held));
}

void require_flat_picture(const fs::path& path, const OpenFile& file) {
  const StoredImage& header = file.header();
  refuse_absurd_sizes(path, header);
  require_visible_pixels(path, header);
  const JpegFacts jpeg = header.format == "jpeg" ? read_jpeg_facts(path, false) : JpegFacts();
  if (jpeg.progressive) require_coefficients_fit(path, header.size, file.channels());
  if (!header.by_rows) require_whole_fits(path, header);
  if (header.slices > 1)
    fail_to_read(path, fmt::format("it is a volume of {} slices; expected a flat picture", header.slices));
  if (header.deep) fail_to_read(path, "it is a deep image (several samples per pixel); expected a flat one");
  if (header.inks || jpeg.components == 4) fail_to_read(path, refusal_of_space("CMYK"));
  if (std::ranges::find(header.channels, "RY") != header.channels.end())
    fail_to_read(path, "it holds luminance and chroma (channels Y, RY, BY); save it with channels R, G and B");
  // The library reads some of these as zeros.
  if (header.type == "double" && header.format == "tiff")
    fail_to_read(path, "its values are 64-bit floats; expected at most 32 bits: save it as 32-bit float");
  if (file.channels() < 1 || file.channels() > 4)
    fail_to_read(path, fmt::format("it has {} channels ({}); expected 1 to 4: save the wanted ones as a separate file",
                                   file.channels(), fmt::join(header.channels, ", ")));
}

[[noreturn]] void fail_cut_off(const fs::path& path) {
  fail_to_read(path, "it is truncated: the end of the image is missing");
}

FileInfo info_of(const OpenFile& file, const std::string& layer) {
  const StoredImage& header = file.header();
  return {.size = file.upright(),
          .channels = file.channels(),
          .depth = header.depth,
          .description = header.description,
          .layer = layer,
          .color_space = header.color_space,
          .orientation = header.orientation,
          .channel_names = header.channels};
}

}  // namespace

OpenFile open_image_file(const fs::path& path, const std::string& layer) {
  require_image_file(path);
  const FormatFacts facts = format_facts(path);
  if (!facts.refusal.empty()) fail_to_read(path, facts.refusal);
  OpenFile file{decoder_of(path), facts};
  if (facts.unused_alpha) file.in->drop_alpha();
  if (const std::vector<std::string> layers = file.in->layers(); layers.size() > 1 || !layer.empty())
    file.in->select(index_of_layer(path, layers, layer));
  require_flat_picture(path, file);
  return file;
}

void require_complete(const fs::path& path, const OpenFile& file) {
  const std::string_view format = file.header().format;
  if (format == "jpeg" && !read_jpeg_facts(path).complete) fail_cut_off(path);
  if (format == "tiff" && !tiff_is_sound(path))
    fail_to_read(path, "it is damaged: a checksum or a length in it is wrong; get the file again from its source");
}

void require_image_file(const fs::path& path) {
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (const std::string kind = irregular_kind(status.type()); !kind.empty())
    fail_to_read(path, fmt::format("it is {}; expected an image file", kind));
  if (!fs::exists(status) && fs::is_symlink(fs::symlink_status(path, failure)))
    fail_to_read(path,
                 fmt::format("it is a link to {}, which does not exist", fs::read_symlink(path, failure).string()));
  if (status.type() == fs::file_type::none) throw_system_error("read", path, failure.value());
  if (!fs::exists(status)) {
    std::vector<std::string> others;
    for (const fs::directory_entry& e : fs::directory_iterator(path.parent_path(), failure))
      others.push_back(e.path().filename().string());
    std::sort(others.begin(), others.end());
    const std::string advice = path_advice("", path.string());
    fail_to_read(path, "there is no such file" +
                           (advice.empty() ? did_you_mean(path.filename().string(), others) : "; " + advice));
  }
  if (::access(path.c_str(), R_OK) != 0) throw_system_error("read", path, errno);
  const auto bytes = fs::file_size(path, failure);
  if (bytes == 0) fail_to_read(path, "the file is empty (0 bytes)");
  if (!failure) require_bytes_fit(path, bytes);
}

namespace {

/// A plan reads the same header several times, and programs plan the same graphs repeatedly. Facts are kept until the
/// file changes; limits are checked each time.
FileFacts<bool> complete_files, plain_pngs;
FileFacts<FileInfo> headers;

}  // namespace

void require_readable_image(const fs::path& path) {
  require_image_file(path);
  const auto seems_whole = [&] {
    refuse_other_content(path);
    return seems_complete(path);
  };
  if (!complete_files.of(path, "", seems_whole)) fail_cut_off(path);
  const auto is_plain_png = [&] {
    try {
      return open_png(path) != nullptr;
    } catch (const Error& e) {
      fail_to_read(path, one_line(e.what()));
    }
  };
  if (!plain_pngs.of(path, "", is_plain_png)) require_image_libraries();
}

FileInfo read_image_info(const fs::path& path, const std::string& layer) {
  require_image_file(path);
  // A JPEG header needs no decoder.
  const JpegFacts jpeg = read_jpeg_facts(path, false);
  if (layer.empty() && (jpeg.components == 1 || jpeg.components == 3) && jpeg.bits == 8 && jpeg.size.area() > 0 &&
      !jpeg.has_exif) {
    require_pixels_fit(path, jpeg.size, jpeg.components);
    if (jpeg.progressive) require_coefficients_fit(path, jpeg.size, jpeg.components);
    return {jpeg.size, jpeg.components, Depth::u8};
  }
  FileInfo info = headers.of(path, layer, [&] { return info_of(open_image_file(path, layer), layer); });
  require_pixels_fit(path, info.size, info.channels);
  return info;
}

std::vector<FileInfo> read_layer_infos(const fs::path& path) {
  if (lowercase(path.extension().string()) != ".exr") return {read_image_info(path)};
  require_image_file(path);
  const OpenFile file{decoder_of(path)};
  const std::vector<std::string> layers = file.in->layers();
  if (layers.size() == 1) require_flat_picture(path, file);  // with several, only reading one reports its faults
  std::vector<FileInfo> infos;
  for (size_t i = 0; i < layers.size(); i++) {
    file.in->select(i);
    infos.push_back(info_of(file, layers[i]));
  }
  return infos;
}

}  // namespace terrazzo
