#include "core/filter/linear_colors.h"

#include <algorithm>
#include <cmath>

#include "core/image/image_ops.h"
#include "core/image/pixel_space.h"

namespace terrazzo {

ImagePtr linear_colors(const ImagePtr& color, const ImagePtr& opacity) {
  const ImageInfo from = color->info();
  const ImageInfo info{.size = from.size, .channels = 4, .semantic = Semantic::data};
  Hasher recipe;
  recipe.add("linear colors").add(color->digest());
  std::vector<ImagePtr> inputs = {color};
  if (opacity) {
    recipe.add(opacity->digest());
    inputs.push_back(opacity);
  }
  const int covers = opacity ? opacity->channels() : 0;
  return pixel_by_pixel(info, recipe.digest(), std::move(inputs), [=](auto in, float* out, int64_t count) {
    const int stored = from.channels, values = value_channels(from);
    std::vector<float> pixels(in[0], in[0] + count * stored);
    to_linear(from, pixels.data(), count);
    for (int64_t i = 0; i < count; i++, out += 4) {
      const float* v = &pixels[size_t(i * stored)];
      bool counts = (values == stored || v[stored - 1] >= 0.5f) && (covers == 0 || in[1][i * covers] >= 0.5f);
      for (int c = 0; c < 3; c++) {
        const float value = v[values < 3 ? 0 : c];
        counts = counts && std::isfinite(value);
        out[c] = std::isfinite(value) ? std::max(value, 0.0f) : 0;
      }
      out[3] = counts ? 1 : 0;
    }
  });
}

}  // namespace terrazzo
