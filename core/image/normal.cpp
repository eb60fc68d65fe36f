#include "core/image/normal.h"

#include <algorithm>
#include <cmath>

#include "core/image/image_ops.h"

namespace terrazzo {

float length(const Vector3f& v) {
  return std::sqrt(v.x() * v.x() + v.y() * v.y() + v.z() * v.z());
}

Vector3f normalized(const Vector3f& v) {
  const float l = length(v);
  return l > 1e-12f ? Vector3f(v / l) : Vector3f(0, 0, 1);
}

Vector3f decode_normal(const float* p, NormalY normal_y) {
  const float y = p[1] * 2 - 1;
  return {p[0] * 2 - 1, normal_y == NormalY::up ? y : -y, p[2] * 2 - 1};
}

void encode_normal(const Vector3f& n, NormalY normal_y, float* p) {
  p[0] = n[0] * 0.5f + 0.5f;
  p[1] = (normal_y == NormalY::up ? n[1] : -n[1]) * 0.5f + 0.5f;
  p[2] = n[2] * 0.5f + 0.5f;
}

void renormalize(float* pixels, int channels, int64_t count) {
  for (int64_t i = 0; i < count; i++) {
    float* p = pixels + i * channels;
    encode_normal(normalized(decode_normal(p, NormalY::up)), NormalY::up, p);
  }
}

namespace {

/// 1 - v; exactly the opposite step if v is one of a file's `steps` steps.
float opposite(float v, float steps) {
  const float step = std::floor(v * steps + 0.5f);
  return step / steps == v ? (steps - step) / steps : 1 - v;
}

}  // namespace

void flip_green(float* pixels, int channels, int64_t count, Depth depth) {
  const float steps = depth == Depth::u8 ? 255 : 65535;
  for (int64_t i = 0; i < count; i++) {
    float& green = pixels[i * channels + 1];
    green = depth <= Depth::u16 ? opposite(green, steps) : 1 - green;
  }
}

Vector3f reoriented(const Vector3f& base, const Vector3f& detail) {
  const Vector3f t = base + Vector3f{0, 0, 1};
  if (t.z() < 1e-6f) return detail;
  const Vector3f u{-detail.x(), -detail.y(), detail.z()};
  const float along = (t.x() * u.x() + t.y() * u.y() + t.z() * u.z()) / t.z();
  return normalized(t * along - u);
}

std::optional<SlopeFilter> slope_filter_from(std::string_view name) {
  if (name == "sobel") return SlopeFilter::sobel;
  if (name == "scharr") return SlopeFilter::scharr;
  if (name == "central") return SlopeFilter::central;
  return std::nullopt;
}

void normals_from_height(const PixelView& height, const Rect& region, double height_scale, SlopeFilter filter,
                         Outside outside, NormalY normal_y, float* out) {
  const Rect around = grown(region, slope_reach);
  const std::vector<float> h = read_padded(height, around, outside);
  const float side = filter == SlopeFilter::central ? 0.0f : filter == SlopeFilter::sobel ? 1.0f : 3.0f;
  const float middle = filter == SlopeFilter::central ? 1.0f : filter == SlopeFilter::sobel ? 2.0f : 10.0f;
  const float scale = static_cast<float>(height_scale / (2.0 * (2 * side + middle)));
  for (int y = 0; y < region.height; y++)
    for (int x = 0; x < region.width; x++) {
      const float* above = &h[size_t(y) * around.width + x];
      const float* here = above + around.width;
      const float* below = here + around.width;
      const float right = side * (above[2] - above[0] + below[2] - below[0]) + middle * (here[2] - here[0]);
      const float up = side * (above[0] - below[0] + above[2] - below[2]) + middle * (above[1] - below[1]);
      encode_normal(normalized({-right * scale, -up * scale, 1}), normal_y, out + (size_t(y) * region.width + x) * 3);
    }
}

ImagePtr with_normal_y(const ImagePtr& image, NormalY wanted) {
  ImageInfo info = image->info();
  if (info.semantic != Semantic::normal || info.normal_y == wanted || info.channels < 2) return image;
  info.normal_y = wanted;
  const Digest recipe = Hasher().add("flipped green").add(image->digest()).digest();
  return pixel_by_pixel(info, recipe, {image}, [info](auto in, float* out, int64_t count) {
    std::copy_n(in[0], count * info.channels, out);
    flip_green(out, info.channels, count, info.depth);
  });
}

}  // namespace terrazzo
