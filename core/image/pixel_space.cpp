#include "core/image/pixel_space.h"

#include <algorithm>

#include "core/image/normal.h"
#include "core/image/srgb.h"

namespace terrazzo {

namespace {

template <typename Curve>
void map_colors(const ImageInfo& info, float* pixels, int64_t count, const Curve& curve) {
  const int colors = info.channels >= 3 ? 3 : 1;
  for (int64_t i = 0; i < count; i++)
    for (int c = 0; c < colors; c++) pixels[i * info.channels + c] = float(curve(pixels[i * info.channels + c]));
}

bool is_encoded(const ImageInfo& info) {
  return info.color_space == "srgb_texture";
}

}  // namespace

int value_channels(const ImageInfo& info) {
  return is_color(info.semantic) && info.channels % 2 == 0 ? info.channels - 1 : info.channels;
}

bool can_be_averaged(const ImageInfo& info) {
  return info.semantic != Semantic::mask && info.semantic != Semantic::guidance;
}

void to_linear(const ImageInfo& info, float* pixels, int64_t count) {
  if (is_encoded(info)) map_colors(info, pixels, count, [](float v) { return decode_srgb(v); });
}

void to_stored(const ImageInfo& info, float* pixels, int64_t count) {
  if (is_encoded(info)) map_colors(info, pixels, count, [](double v) { return encode_srgb(v); });
  if (info.semantic == Semantic::normal && info.channels >= 3) renormalize(pixels, info.channels, count);
  keep_in_range(info, pixels, count);
}

void keep_in_range(const ImageInfo& info, float* pixels, int64_t count) {
  if (info.depth != Depth::u8 && info.depth != Depth::u16) return;
  for (int64_t i = 0; i < count * info.channels; i++) pixels[i] = std::clamp(pixels[i], 0.0f, 1.0f);
}

}  // namespace terrazzo
