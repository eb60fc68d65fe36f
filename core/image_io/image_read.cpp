#include <algorithm>
#include <cmath>
#include <new>
#include <span>

#include <Imath/half.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/tuning.h"
#include "core/image/pixel_space.h"
#include "core/image_io/color.h"
#include "core/image_io/image_file.h"
#include "core/image_io/image_open.h"
#include "core/image_io/stored_values.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

struct ImageReadTuning {
  double clearly_negative = -0.01;
};
const Tunable<ImageReadTuning> image_read_tuning(
    "image_read", {
                      {&ImageReadTuning::clearly_negative, "clearly_negative", "of the range of values",
                       "below which normals are taken for signed numbers. Higher: encoded ones that were "
                       "filtered are taken for them; lower: nearly flat ones are not",
                       "not measured: what filters undershoot zero by is no sign", -1, 0},
                  });

/// The stored pixels in the requested depth. Throws Cancelled by the current task.
template <typename T>
std::vector<T> read_stored(const fs::path& path, const OpenFile& file, Depth as) {
  // Larger: keeps multi-threaded decoders busy; smaller: reacts faster to cancellation.
  constexpr int64_t values_at_once = int64_t{1} << 23;
  const Task& task = CurrentTask::task();
  task.check();
  require_complete(path, file);
  const StoredImage& header = file.header();
  std::vector<T> out(size_t(header.stored.area()) * file.channels());
  const int64_t row = int64_t{header.stored.width} * file.channels();
  try {
    if (!header.by_rows || int64_t(out.size()) <= values_at_once) {
      file.in->read(as, out.data());
    } else {
      const int step = file.in->row_step();
      const int rows = step * int(std::max<int64_t>(1, values_at_once / (row * step)));
      for (int y = 0; y < header.stored.height; y += rows) {
        task.check();
        file.in->read_rows(y, std::min(y + rows, header.stored.height), as, out.data() + size_t(row) * size_t(y));
      }
    }
  } catch (const Error& e) {
    fail_to_read(path, "it is damaged or cut off: " + one_line(e.what()));
  }
  return out;
}

/// Places the stored pixels in the upright image; all others are 0.
template <typename T>
std::vector<T> placed(const OpenFile& file, std::vector<T> stored) {
  const Rect from = file.header().stored, all = whole(file.header().size);
  const int orientation = file.orientation();
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

using Warn = std::function<void(const std::string&)>;

StoredMeaning meaning_of(const OpenFile& file, const ImageInfo& info) {
  const StoredImage& header = file.header();
  return {.facts = file.facts,
          .stored = header.stored,
          .channels = file.channels(),
          .is_float = header.depth == Depth::f16 || header.depth == Depth::f32,
          .integer_range = header.type == "uint"  ? double(std::numeric_limits<uint32_t>::max())
                           : header.type == "int" ? double(std::numeric_limits<int32_t>::max())
                                                  : 0,
          .is_colour = is_color(info.semantic),
          .may_be_premultiplied = header.format == "openexr" && is_color(info.semantic) && header.description.empty(),
          .can_be_averaged = can_be_averaged(info)};
}

void warn_of_values(const fs::path& path, const StoredValues& stored, const Warn& warn) {
  try {
    for (const StoredValues::Remark& r : stored.remarks())
      warn(fmt::format("{}{}: {}", r.is_loss ? warning_mark : "", path.filename().string(), r.text));
  } catch (const Error& e) {
    fail_to_read(path, e.what());
  }
}

std::vector<StoredValues::Hole> filled_holes(const fs::path& path, const StoredValues& stored,
                                             const std::function<void(const Rect&, float*)>& read) {
  try {
    return stored.filled_holes(read);
  } catch (const Error& e) {
    fail_to_read(path, e.what());
  }
}

bool are_signed_normals(std::span<const float> values) {
  const auto clearly_negative = float(image_read_tuning->clearly_negative);
  return std::ranges::any_of(values, [clearly_negative](float v) { return v < clearly_negative; });
}

void warn_of_signed_normals(const fs::path& path, const Warn& warn) {
  warn(fmt::format("{}: its normals are stored as signed numbers; they were encoded as n * 0.5 + 0.5",
                   path.filename().string()));
}

/// If all parts have the same window, the message does not name the layer, so that it is reported once for all layers.
void warn_of_window(const fs::path& path, const StoredImage& header, const std::string& layer, const Warn& warn) {
  warn(
      fmt::format("{}{}{}: its data window, {}, is larger than its display window; the display window of {} was read: "
                  "data outside of it is left out",
                  warning_mark, path.filename().string(),
                  header.stored_differs && !layer.empty() ? fmt::format(" (layer {})", layer) : "",
                  described_window(header.stored), describe(header.size)));
}

void warn_of_layout(const fs::path& path, OpenFile& file, const std::string& layer, const Warn& warn) {
  const std::string name = path.filename().string();
  const StoredImage& header = file.header();
  if (!header.exact) warn(fmt::format("{}: values of type {} are converted to 32-bit floats", name, header.type));
  if (header.stored != whole(header.size)) warn_of_window(path, header, layer, warn);
  if (file.orientation() != 1)
    warn(fmt::format("{}: rotated upright, as its orientation tag ({}) says", name, file.orientation()));
  if (!header.note.empty()) warn(fmt::format("{}: {}", name, header.note));
  if (file.in->has_more_images()) warn(fmt::format("{}: it holds several images; the first was read", name));
}

/// No layer was asked for, and the file holds further layers.
void warn_of_layers(const fs::path& path, const OpenFile& file, const std::string& layer, const Warn& warn) {
  const std::vector<std::string> layers = file.in->layers();
  if (layer.empty() && layers.size() > 1)
    warn(fmt::format("{}: its channels without a layer were read; it also holds {}", path.filename().string(),
                     listed_layers(layers)));
}

/// The stored pixels strip by strip, or as one strip if they do not come row by row.
template <typename T>
void for_stored_strips(const fs::path& path, const OpenFile& file, Depth as,
                       const std::function<void(int first, int rows, std::span<T> values)>& visit) {
  constexpr int64_t values_at_once = int64_t{1} << 18;
  const StoredImage& header = file.header();
  const int64_t row = int64_t{header.stored.width} * file.channels();
  if (!header.by_rows) {
    std::vector<T> all = read_stored<T>(path, file, as);
    return visit(0, header.stored.height, all);
  }
  require_complete(path, file);
  const int step = file.in->row_step();
  const int rows = step * int(std::max<int64_t>(1, values_at_once / (row * step)));
  std::vector<T> values(size_t(row) * size_t(std::min(rows, header.stored.height)));
  for (int y = 0; y < header.stored.height; y += rows) {
    const int end = std::min(y + rows, header.stored.height);
    try {
      file.in->read_rows(y, end, as, values.data());
    } catch (const Error& e) {
      fail_to_read(path, "it is damaged or cut off: " + one_line(e.what()));
    }
    visit(y, end - y, std::span(values).first(size_t(row) * size_t(end - y)));
  }
}

/// Reads the pixels into a scratch file. Null if there is no room on the disk.
ImagePtr read_to_disk(const fs::path& path, const OpenFile& file, const ImageInfo& info, const Warn& warn) {
  const bool is_normal = info.semantic == Semantic::normal;
  const Depth depth = info.depth == Depth::f16 && is_normal ? Depth::f32 : info.depth;
  const std::shared_ptr<FilePixels> pixels = FilePixels::make(file.layout(depth));
  if (!pixels) return nullptr;
  StoredValues stored(meaning_of(file, info));
  bool are_signed = false;
  const auto keep = [&](int first, int rows, auto values) {
    stored.mend(values);
    pixels->write_rows(first, rows, values.data());
  };
  switch (depth) {
    case Depth::u8:
      for_stored_strips<uint8_t>(path, file, depth, keep);
      break;
    case Depth::u16:
    case Depth::f16:
      for_stored_strips<uint16_t>(path, file, depth, keep);
      break;
    case Depth::f32:
      for_stored_strips<float>(path, file, depth, [&](int first, int rows, std::span<float> values) {
        keep(first, rows, values);
        are_signed = are_signed || (is_normal && are_signed_normals(values));
      });
      break;
  }
  const auto read = [&](const Rect& region, float* out) { pixels->read_stored_floats(region, out); };
  for (const StoredValues::Hole& hole : filled_holes(path, stored, read))
    pixels->replace(hole.x, hole.y, hole.channel, hole.value);
  if (stored.is_invisible()) pixels->make_opaque();
  warn_of_values(path, stored, warn);
  if (are_signed) {
    pixels->encode();
    warn_of_signed_normals(path, warn);
  }
  return FilePixels::image(info, pixels);
}

/// The upright pixels with the values that the file means. Halfs come as their bits.
template <typename T>
std::vector<T> read_meant(const fs::path& path, const OpenFile& file, const ImageInfo& info, Depth as,
                          const Warn& warn) {
  StoredValues stored(meaning_of(file, info));
  std::vector<T> values = read_stored<T>(path, file, as);
  CurrentTask::task().check();
  stored.mend(values);
  CurrentTask::task().check();
  const auto channels = size_t(file.channels()), width = size_t(file.header().stored.width);
  const auto at = [&](int x, int y) { return (size_t(y) * width + size_t(x)) * channels; };
  const auto to_float = [&](T v) { return as == Depth::f16 ? imath_half_to_float(uint16_t(v)) : float(v); };
  const auto read = [&](const Rect& region, float* out) {
    for (int y = region.y; y < region.bottom(); y++) {
      const auto row = values.begin() + ptrdiff_t(at(region.x, y));
      out = std::transform(row, row + ptrdiff_t(size_t(region.width) * channels), out, to_float);
    }
  };
  for (const StoredValues::Hole& hole : filled_holes(path, stored, read))
    values[at(hole.x, hole.y) + size_t(hole.channel)] =
        as == Depth::f16 ? T(imath_float_to_half(hole.value)) : T(hole.value);
  if (stored.is_invisible())
    for (size_t i = channels - 1; i < values.size(); i += channels)
      values[i] = as == Depth::f16   ? T(imath_float_to_half(1))
                  : as == Depth::f32 ? T(1)
                                     : std::numeric_limits<T>::max();
  warn_of_values(path, stored, warn);
  CurrentTask::task().check();
  return placed(file, std::move(values));
}

ImagePtr read_opened(const fs::path& path, OpenFile& file, const ImageInfo& given, const std::string& layer,
                     const Warn& warn) {
  ImageInfo info = given;
  info.size = file.upright();
  info.channels = file.channels();
  info.depth = file.header().depth;
  warn_of_layout(path, file, layer, warn);
  const uint64_t bytes = uint64_t(info.size.area()) * uint64_t(info.channels) * sizeof(float);
  if (!PixelRoom::has(bytes))
    if (ImagePtr image = read_to_disk(path, file, info, warn)) return image;
  const PixelRoom meanwhile(bytes);
  const bool is_normal = info.semantic == Semantic::normal;
  if (info.depth == Depth::u8)
    return Image::from_integers(info, read_meant<uint8_t>(path, file, info, Depth::u8, warn));
  if (info.depth == Depth::u16)
    return Image::from_integers(info, read_meant<uint16_t>(path, file, info, Depth::u16, warn));
  if (info.depth == Depth::f16 && !is_normal)
    return Image::from_halfs(info, read_meant<uint16_t>(path, file, info, Depth::f16, warn));
  std::vector<float> floats = read_meant<float>(path, file, info, Depth::f32, warn);
  if (is_normal && are_signed_normals(floats)) {
    for (float& v : floats) v = v * 0.5f + 0.5f;
    warn_of_signed_normals(path, warn);
  }
  return Image::from_floats(info, std::move(floats));
}

}  // namespace

ImagePtr read_image(const fs::path& path, const ImageInfo& info, const Warn& warn, const std::string& layer,
                    bool as_stored) {
  OpenFile file = open_image_file(path, layer);
  file.as_stored = as_stored;
  warn_of_layers(path, file, layer, warn);
  try {
    return read_opened(path, file, info, layer, warn);
  } catch (const std::bad_alloc&) {
    fail_to_read(path, fmt::format("{}x{} pixels of {} do not fit in memory", file.header().size.width,
                                   file.header().size.height, counted(file.channels(), "channel")));
  }
}

}  // namespace terrazzo
