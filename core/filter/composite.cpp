#include "core/filter/composite.h"

#include <algorithm>
#include <cmath>

#include "core/image/image_ops.h"
#include "core/image/normal.h"
#include "core/image/pixel_space.h"

namespace terrazzo {

namespace {

float blended(BlendMode mode, float base, float top) {
  switch (mode) {
    case BlendMode::normal:
      return top;
    case BlendMode::multiply:
      return base * top;
    case BlendMode::screen:
      return 1 - (1 - base) * (1 - top);
    case BlendMode::overlay:
      return base < 0.5f ? 2 * base * top : 1 - 2 * (1 - base) * (1 - top);
    case BlendMode::add:
      return base + top;
    case BlendMode::subtract:
      return base - top;
    case BlendMode::difference:
      return std::fabs(base - top);
    case BlendMode::min:
      return std::min(base, top);
    case BlendMode::max:
      return std::max(base, top);
  }
  return top;
}

std::vector<ImagePtr> connected(const BlendInputs& inputs) {
  std::vector<ImagePtr> images = {inputs.base, inputs.top};
  if (inputs.mask) images.push_back(inputs.mask);
  return images;
}

}  // namespace

ImagePtr blend_values(const BlendInputs& inputs, BlendMode mode, bool linear, const Digest& recipe) {
  const ImageInfo info = inputs.base->info(), top_info = inputs.top->info();
  const float opacity = float(inputs.opacity);
  return pixel_by_pixel(info, recipe, connected(inputs), [=](auto in, float* out, int64_t count) {
    const int channels = info.channels, top_channels = top_info.channels;
    std::vector<float> top(in[1], in[1] + count * top_channels);
    std::copy_n(in[0], count * channels, out);
    if (linear) {
      to_linear(info, out, count);
      to_linear(top_info, top.data(), count);
    }
    for (int64_t i = 0; i < count; i++) {
      const float amount = in.size() > 2 ? opacity * in[2][i] : opacity;
      for (int c = 0; c < channels; c++) {
        float& base = out[i * channels + c];
        base += amount * (blended(mode, base, top[i * top_channels + (top_channels == 1 ? 0 : c)]) - base);
      }
    }
    if (linear)
      to_stored(info, out, count);
    else
      keep_in_range(info, out, count);
  });
}

ImagePtr blend_normals(const BlendInputs& inputs, bool detail, const Digest& recipe) {
  const ImageInfo info = inputs.base->info(), top_info = inputs.top->info();
  const float opacity = float(inputs.opacity);
  return pixel_by_pixel(info, recipe, connected(inputs), [=](auto in, float* out, int64_t count) {
    std::copy_n(in[0], count * info.channels, out);
    for (int64_t i = 0; i < count; i++) {
      const float amount = in.size() > 2 ? opacity * in[2][i] : opacity;
      const Vector3f base = normalized(decode_normal(in[0] + i * info.channels, info.normal_y));
      const Vector3f top = normalized(decode_normal(in[1] + i * top_info.channels, top_info.normal_y));
      const Vector3f from = detail ? Vector3f{0, 0, 1} : base;
      const Vector3f mixed = normalized(from + amount * (top - from));
      encode_normal(detail ? reoriented(base, mixed) : mixed, info.normal_y, out + i * info.channels);
    }
  });
}

}  // namespace terrazzo
