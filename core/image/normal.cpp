#include "core/image/normal.h"

#include <cmath>

namespace terrazzo {

Vector3 normalized(const Vector3& v) {
  const float length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  if (!(length > 1e-12f)) return {0, 0, 1};
  return {v[0] / length, v[1] / length, v[2] / length};
}

Vector3 decode_normal(const float* p, NormalY normal_y) {
  const float y = p[1] * 2 - 1;
  return {p[0] * 2 - 1, normal_y == NormalY::up ? y : -y, p[2] * 2 - 1};
}

void encode_normal(const Vector3& n, NormalY normal_y, float* p) {
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

Vector3 reoriented(const Vector3& base, const Vector3& detail) {
  const Vector3 t = {base[0], base[1], base[2] + 1};
  if (t[2] < 1e-6f) return detail;
  const Vector3 u = {-detail[0], -detail[1], detail[2]};
  const float along = (t[0] * u[0] + t[1] * u[1] + t[2] * u[2]) / t[2];
  return normalized({t[0] * along - u[0], t[1] * along - u[1], t[2] * along - u[2]});
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

}  // namespace terrazzo
