#include "core/filter/curvature.h"

#include "core/image/normal.h"

namespace terrazzo {

namespace {

/// 1 / the distance between a pixel's two neighbours; at a border the pixel itself stands for the missing one.
float per_distance(int at, int count, Outside outside) {
  if (outside == Outside::wrap) return 0.5f;
  const int distance = (at > 0) + (at + 1 < count);
  return distance == 0 ? 0 : 1 / float(distance);
}

}  // namespace

void leanings_from_height(const PixelView& height, const Rect& region, double height_scale, Outside outside,
                          float* out) {
  const Rect around = grown(region, curvature_reach);
  const std::vector<float> h = read_padded(height, around, outside);
  const float scale = static_cast<float>(height_scale);
  for (int y = 0; y < region.height; y++) {
    const float down_per = scale * per_distance(region.y + y, height.size().height, outside);
    for (int x = 0; x < region.width; x++) {
      const float* here = &h[size_t(y + 1) * size_t(around.width) + size_t(x + 1)];
      const float right = (here[1] - here[-1]) * (scale * per_distance(region.x + x, height.size().width, outside));
      const float down = (here[around.width] - here[-around.width]) * down_per;
      const Vector3f n = normalized({-right, -down, 1});
      *out++ = n.x();
      *out++ = n.y();
    }
  }
}

void leanings_from_normals(const float* normals, int channels, NormalY normal_y, int64_t count, float* out) {
  for (int64_t i = 0; i < count; i++) {
    const Vector3f n = normalized(decode_normal(normals + i * channels, normal_y));
    *out++ = n.x();
    *out++ = -n.y();
  }
}

void curvature_from_leanings(const PixelView& leanings, const Rect& region, Outside outside, float* out) {
  const Rect around = grown(region, curvature_reach);
  const std::vector<float> n = read_padded(leanings, around, outside);
  const ptrdiff_t stride = ptrdiff_t{2} * around.width;
  for (int y = 0; y < region.height; y++) {
    const float down_per = per_distance(region.y + y, leanings.size().height, outside);
    for (int x = 0; x < region.width; x++) {
      const float* here = &n[size_t(y + 1) * size_t(stride) + 2 * size_t(x + 1)];
      const float across = (here[2] - here[-2]) * per_distance(region.x + x, leanings.size().width, outside);
      const float along = (here[1 + stride] - here[1 - stride]) * down_per;
      *out++ = (across + along) / 2;
    }
  }
}

}  // namespace terrazzo
