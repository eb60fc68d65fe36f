#include "runner/report/pictures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "core/base/base64.h"
#include "core/base/text.h"
#include "core/image_io/color.h"
#include "core/image_io/image_file.h"

namespace terrazzo {

namespace {

constexpr int small_side = 96;
/// The limit for all pictures of a page, about ten megabytes.
constexpr double page_pixels = 14e6;
constexpr int least_side = 128;
/// Below this, PNG is hardly larger than JPEG, and lossless.
constexpr int64_t least_jpeg_area = 64 * 64;
constexpr int jpeg_quality = 90;

bool is_colour(const Image& image) {
  return image.info().color_space != "raw";
}

Size fitted(Size full, int longest) {
  const double scale = std::min(1.0, static_cast<double>(longest) / std::max(full.width, full.height));
  return {std::max(1, static_cast<int>(full.width * scale)), std::max(1, static_cast<int>(full.height * scale))};
}

struct Range {
  float least = 0, most = 1;
};

/// Each pixel of the result is the mean of the pixels it covers. Sets `range` to the range of the values. Lazy pixels
/// are computed by all threads, some rows at a time.
std::vector<float> means(const Image& image, Size size, int channels, Range& range) {
  constexpr int64_t most_rows = 64, most_values = 1 << 21;
  const int from = image.channels(), common = std::min(from, channels);
  const int64_t width = image.width(), height = image.height();
  std::vector<size_t> column;  // by column of the image
  for (int64_t x = 0; x < width; x++) column.push_back(static_cast<size_t>(x * size.width / width));
  const int64_t rows = std::clamp<int64_t>(most_values / (width * from), 1, most_rows);
  const int64_t band = std::max<int64_t>(1, rows * size.height / height);
  const auto first_row = [&](int64_t row) { return (row * height + size.height - 1) / size.height; };
  std::vector<float> out(static_cast<size_t>(size.area()) * channels);
  const Task& task = CurrentTask::task();
  tbb::parallel_for(int64_t{0}, (size.height + band - 1) / band, [&](int64_t part) {
    const CurrentTask scope(task);
    const int64_t begin = part * band, end = std::min<int64_t>(size.height, begin + band);
    std::vector<double> sums(static_cast<size_t>((end - begin) * size.width) * channels, 0.0);
    std::vector<int> counts(static_cast<size_t>((end - begin) * size.width), 0);
    std::vector<float> buffer;
    for (int64_t y = first_row(begin); y < first_row(end); y += rows) {
      task.check();
      const Rect strip{0, static_cast<int>(y), image.width(), static_cast<int>(std::min(rows, first_row(end) - y))};
      const float* pixels = image.in_memory();
      if (pixels) {
        pixels += y * width * from;
      } else {
        buffer.resize(static_cast<size_t>(strip.area()) * from);
        image.read(strip, buffer.data());
        pixels = buffer.data();
      }
      for (int64_t i = y; i < strip.bottom(); i++) {
        const auto row = static_cast<size_t>((i * size.height / height - begin) * size.width);
        for (const size_t at : column) {
          counts[row + at]++;
          for (int c = 0; c < common; c++) sums[(row + at) * channels + c] += pixels[c];
          pixels += from;
        }
      }
    }
    float* to = &out[static_cast<size_t>(begin * size.width) * channels];
    for (size_t i = 0; i < sums.size(); i++) to[i] = static_cast<float>(sums[i] / counts[i / channels]);
  });
  for (const float v : out) range = {std::min(range.least, v), std::max(range.most, v)};
  return out;
}

/// Shrunk, with values in [0, 1].
ImagePtr shrunk(const Image& image, int longest) {
  const int channels = image.channels() == 1 ? 1 : 3;
  ImageInfo info{.size = fitted(image.size(), longest), .channels = channels, .semantic = image.info().semantic};
  info.color_space = image.info().color_space;
  info.normal_y = image.info().normal_y;
  Range range;
  std::vector<float> out = means(image, info.size, channels, range);
  if (info.semantic != Semantic::height) range = {};
  for (float& v : out) v = std::clamp((v - range.least) / (range.most - range.least), 0.0f, 1.0f);
  return Image::from_floats(info, std::move(out));
}

Histogram histogram_of(const Image& image) {
  Histogram out{};
  const std::vector<float> pixels = image.pixels();
  const auto channels = static_cast<size_t>(image.channels());
  const size_t count = pixels.size() / channels;
  for (size_t i = 0; i < count; i++) {
    float sum = 0;
    for (size_t c = 0; c < channels; c++) sum += pixels[i * channels + c];
    const float mean = std::clamp(sum / static_cast<float>(channels), 0.0f, 1.0f);
    out[std::min(out.size() - 1, static_cast<size_t>(mean * static_cast<float>(out.size())))]++;
  }
  for (float& v : out) v /= static_cast<float>(count);
  return out;
}

std::string uri_of(const Image& display) {
  const PictureFile file = picture_file(display);
  return "data:" + file.type + ";base64," + base64(file.bytes);
}

}  // namespace

ImagePtr shrunk_for_display(const ImagePtr& image, int longest) {
  const ImagePtr out = shrunk(*image, longest);
  return is_colour(*image) ? materialized(convert_color(out, "srgb_texture")) : out;
}

PictureFile picture_file(const Image& display, bool exact) {
  if (!exact && is_colour(display) && display.size().area() >= least_jpeg_area) try {
      return {"image/jpeg", encoded_file(display, {.format = FileFormat::jpeg, .jpeg_quality = jpeg_quality})};
    } catch (const Error&) {
      // The module that writes JPEG is missing: PNG is larger, but needs no module.
    }
  return {"image/png", encoded_file(display)};
}

PagePicture page_picture(const ImagePtr& image, int longest) {
  const ImagePtr page = shrunk_for_display(image, longest);
  const ImagePtr small = shrunk(*page, small_side);
  return {uri_of(*page), uri_of(*small), image->size(), page, histogram_of(*page)};
}

ImagePtr uv_in_colours(const UvMap& uv, int longest) {
  ImageInfo info{.size = fitted(uv.size(), longest), .channels = 3, .semantic = Semantic::data};
  std::vector<float> out;
  out.reserve(static_cast<size_t>(info.size.area()) * 3);
  const auto middle = [](int at, int few, int all) {
    return static_cast<int>((2 * int64_t{at} + 1) * all / (2 * few));
  };
  const auto share = [](int at, int all) { return (static_cast<float>(at) + 0.5f) / static_cast<float>(all); };
  for (int y = 0; y < info.size.height; y++)
    for (int x = 0; x < info.size.width; x++) {
      const ExemplarPixel from =
          uv.at(middle(x, info.size.width, uv.size().width), middle(y, info.size.height, uv.size().height));
      out.insert(out.end(), {share(from.x, uv.exemplar().width), share(from.y, uv.exemplar().height), 0.3f});
    }
  return Image::from_floats(info, std::move(out));
}

int side_for(size_t count, int longest) {
  const double side = std::sqrt(page_pixels / static_cast<double>(std::max<size_t>(count, 1)));
  return std::clamp(static_cast<int>(side), std::min(least_side, longest), longest);
}

std::string PagePictures::add(const ImagePtr& image, int longest) {
  const auto [at, is_new] = ids_.try_emplace({image->digest().hex(), image->info().semantic});
  if (is_new) {
    at->second = fmt::format("picture-{}", ids_.size());
    pictures_[at->second].picture = page_picture(image, longest);
  }
  return at->second;
}

std::string PagePictures::figure(const std::string& id, const std::string& caption) {
  Shown& shown = pictures_.at(id);
  const std::string source =
      shown.on_page ? fmt::format("data-same=\"{}\"", id) : fmt::format("id=\"{}\" src=\"{}\"", id, shown.picture.uri);
  shown.on_page = true;
  const Size size = shown.picture.size;
  return fmt::format(
      "<figure><img class=\"picture\" {} alt=\"{}\" loading=\"lazy\" decoding=\"async\" width=\"{}\" "
      "height=\"{}\"><figcaption>{}, {}&times;{}</figcaption></figure>\n",
      source, markup(caption), size.width, size.height, markup(caption), size.width, size.height);
}

}  // namespace terrazzo
