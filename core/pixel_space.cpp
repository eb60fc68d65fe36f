#include "core/pixel_space.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/color.h"
#include "core/normal.h"

namespace terrazzo {

namespace {

template <float (*Curve)(float)>
void map_colors(const ImageInfo& info, float* pixels, int64_t count) {
  const int colors = info.channels >= 3 ? 3 : 1;
  for (int64_t i = 0; i < count; i++)
    for (int c = 0; c < colors; c++) pixels[i * info.channels + c] = Curve(pixels[i * info.channels + c]);
}

float computed_decode(float v) {
  const float a = std::fabs(v);
  return std::copysign(a <= 0.04045f ? a / 12.92f : std::pow((a + 0.055f) / 1.055f, 2.4f), v);
}

/// The values of 8-bit files, which are most of those that are ever decoded.
std::array<float, 256> table_of_bytes() {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; i++) table[i] = computed_decode(float(i) / 255);
  return table;
}

bool is_encoded(const ImageInfo& info) {
  return info.color_space == "srgb_texture";
}

}  // namespace

int value_channels(const ImageInfo& info) {
  return is_color(info.semantic) && info.channels % 2 == 0 ? info.channels - 1 : info.channels;
}

float decode_srgb(float v) {
  static const std::array<float, 256> table = table_of_bytes();
  const int byte = v >= 0 && v <= 1 ? int(v * 255 + 0.5f) : 0;
  return float(byte) / 255 == v ? table[byte] : computed_decode(v);
}

float encode_srgb(float v) {
  const float a = std::fabs(v);
  return std::copysign(a <= 0.0031308f ? a * 12.92f : 1.055f * std::pow(a, 1 / 2.4f) - 0.055f, v);
}

void to_linear(const ImageInfo& info, float* pixels, int64_t count) {
  if (is_encoded(info)) map_colors<decode_srgb>(info, pixels, count);
}

void to_stored(const ImageInfo& info, float* pixels, int64_t count) {
  if (is_encoded(info)) map_colors<encode_srgb>(info, pixels, count);
  if (info.semantic == Semantic::normal && info.channels >= 3) renormalize(pixels, info.channels, count);
  keep_in_range(info, pixels, count);
}

void keep_in_range(const ImageInfo& info, float* pixels, int64_t count) {
  if (info.depth != Depth::u8 && info.depth != Depth::u16) return;
  for (int64_t i = 0; i < count * info.channels; i++) pixels[i] = std::clamp(pixels[i], 0.0f, 1.0f);
}

}  // namespace terrazzo
