#include "core/stochastic/blending_space.h"

#include <algorithm>
#include <cmath>

#include "core/image/image_ops.h"
#include "core/image/normal.h"
#include "core/image/pixel_space.h"
#include "core/resolve/resolve.h"

namespace terrazzo {

namespace {

/// What rounding to 8 bits may add to a length of 1.
constexpr float rounding = 0.01f;

bool is_vector(const ImageInfo& info) {
  return info.semantic == Semantic::normal && info.channels >= 3;
}

void to_direction_and_length(float* pixel) {
  const Vector3f n = decode_normal(pixel, NormalY::up);
  const float size = length(n);
  encode_normal(normalized(n), NormalY::up, pixel);
  pixel[2] = std::abs(size - 1) < rounding ? 1 : size;
}

void to_vector(float* pixel) {
  const float size = pixel[2];
  Vector3f n = decode_normal(pixel, NormalY::up);
  n.z() = std::sqrt(std::max(0.0f, 1 - n.x() * n.x() - n.y() * n.y()));
  encode_normal(normalized(n) * size, NormalY::up, pixel);
}

}  // namespace

bool blends_samples(const ImageInfo& info) {
  return can_be_averaged(info) && can_blend(info.semantic);
}

ImagePtr in_blending_space(const ImagePtr& map) {
  if (!is_vector(map->info())) return map;
  const int channels = map->channels();
  ImageInfo info = map->info();
  info.depth = Depth::f32;
  const auto convert = [channels](std::span<const float* const> in, float* out, int64_t count) {
    std::copy_n(in[0], count * channels, out);
    for (int64_t i = 0; i < count; i++) to_direction_and_length(out + i * channels);
  };
  Hasher recipe;
  recipe.add("in_blending_space").add(map->digest());
  return pixel_by_pixel(info, recipe.digest(), {map}, convert);
}

void from_blending_space(const ImageInfo& info, float* pixels, int64_t count) {
  if (!is_vector(info)) return;
  for (int64_t i = 0; i < count; i++) to_vector(pixels + i * info.channels);
  keep_in_range(info, pixels, count);
}

}  // namespace terrazzo
