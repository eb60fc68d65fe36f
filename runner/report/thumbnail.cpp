#include "runner/report/thumbnail.h"

#include <algorithm>

#include "core/image/color.h"
#include "core/image/image_file.h"

namespace terrazzo {

namespace {

/// Each pixel of the result is the mean of the pixels it stands for.
ImagePtr shrunk(const ImagePtr& image, Size size, int channels) {
  const int from = image->channels(), common = std::min(from, channels);
  const auto to_small = [](int at, int all, int few) { return static_cast<int>(int64_t{at} * few / all); };
  std::vector<double> sums(static_cast<size_t>(size.area()) * channels, 0.0);
  std::vector<int> counts(static_cast<size_t>(size.area()), 0);
  for_each_strip(*image, [&](const Rect& region, const float* pixels) {
    for (int y = region.y; y < region.bottom(); y++)
      for (int x = 0; x < region.width; x++, pixels += from) {
        const size_t at = static_cast<size_t>(to_small(y, image->height(), size.height)) * size.width +
                          static_cast<size_t>(to_small(x, image->width(), size.width));
        counts[at]++;
        for (int c = 0; c < common; c++) sums[at * channels + c] += pixels[c];
      }
  });
  std::vector<float> out(sums.size());
  for (size_t i = 0; i < sums.size(); i++)
    out[i] = static_cast<float>(std::clamp(sums[i] / counts[i / channels], 0.0, 1.0));
  ImageInfo info{.size = size, .channels = channels, .semantic = image->info().semantic};
  info.color_space = image->info().color_space;
  return Image::from_floats(info, std::move(out));
}

std::string base64(const std::vector<uint8_t>& bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](size_t at) -> uint32_t { return at < bytes.size() ? bytes[at] : 0; };
    const uint32_t bits = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    for (size_t d = 0; d < 4; d++) out += i + d > bytes.size() ? '=' : digits[bits >> (18 - 6 * d) & 63];
  }
  return out;
}

}  // namespace

std::string thumbnail_uri(const ImagePtr& image, int longest) {
  const Size full = image->size();
  const double scale = std::min(1.0, static_cast<double>(longest) / std::max(full.width, full.height));
  const Size size = {std::max(1, static_cast<int>(full.width * scale)),
                     std::max(1, static_cast<int>(full.height * scale))};
  ImagePtr small = shrunk(image, size, image->channels() == 1 ? 1 : 3);
  if (small->info().color_space != "raw") small = convert_color(small, "srgb_texture");
  return "data:image/png;base64," + base64(png_of(*small));
}

}  // namespace terrazzo
