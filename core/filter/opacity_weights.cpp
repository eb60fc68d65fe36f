#include "core/filter/opacity_weights.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/filter/resample.h"
#include "core/image/image_facts.h"
#include "core/image/image_ops.h"
#include "core/image/pixel_space.h"
#include "core/image_io/color.h"

namespace terrazzo {

namespace {

/// A quarter of an 8-bit step: invisible, and its colour is that of rounding.
constexpr float least_seen = 1.0f / 1024;

bool has_alpha(const ImageInfo& info) {
  return value_channels(info) < info.channels;
}

/// Whether weighting by the image's last channel would change anything.
bool varies(const Image& image, int channel) {
  bool any_hidden = false, any_seen = false;
  for_each_strip(image, [&](const Rect& r, const float* v) {
    for (int64_t i = 0; i < r.area(); i++) {
      const float weight = v[i * image.channels() + channel];
      any_hidden |= weight < 1;
      any_seen |= weight > 0;
    }
  });
  return any_hidden && any_seen;
}

ImagePtr one_channel(const ImagePtr& image, int channel) {
  const ImageInfo info{.size = image->size(), .channels = 1};
  const Digest recipe = Hasher().add("weights").add(image->digest()).add(channel).digest();
  return pixel_by_pixel(info, recipe, {image}, [channel, step = image->channels()](auto in, float* out, int64_t count) {
    for (int64_t i = 0; i < count; i++) out[i] = std::clamp(in[0][i * step + channel], 0.0f, 1.0f);
  });
}

Digest recipe_of(const char* what, const Digest& of, const Digest& with) {
  return Hasher().add(what).add(of).add(with).digest();
}

}  // namespace

ImagePtr opacity_weights(const ImagePtr& image, const ImagePtr& opacity) {
  const ImageInfo& info = image->info();
  if (!is_color(info.semantic)) return nullptr;
  if (has_alpha(info)) return varies(*image, info.channels - 1) ? one_channel(image, info.channels - 1) : nullptr;
  if (!opacity || !varies(*opacity, 0)) return nullptr;
  return nearest_at_size(one_channel(opacity, 0), image->size());
}

ImagePtr premultiplied(const ImagePtr& image, const ImagePtr& weights) {
  const ImageInfo info = image->info();
  const int colors = value_channels(info);
  return pixel_by_pixel({.size = info.size, .channels = colors + 1},
                        recipe_of("premultiplied", image->digest(), weights->digest()), {image, weights},
                        [info, colors](auto in, float* out, int64_t count) {
                          std::array<float, 4> pixel;
                          for (int64_t i = 0; i < count; i++) {
                            std::copy_n(in[0] + i * info.channels, info.channels, pixel.data());
                            to_linear(info, pixel.data(), 1);
                            for (int c = 0; c < colors; c++) *out++ = pixel[c] * in[1][i];
                            *out++ = in[1][i];
                          }
                        });
}

ImagePtr unpremultiplied(const ImagePtr& premultiplied, const ImageInfo& info, const ImagePtr& hidden) {
  const int colors = value_channels(info);
  std::vector<ImagePtr> inputs = {premultiplied};
  if (hidden) inputs.push_back(nearest_at_size(hidden, info.size));
  Hasher recipe;
  recipe.add("unpremultiplied");
  info.add_to(recipe);
  for (const ImagePtr& i : inputs) recipe.add(i->digest());
  return pixel_by_pixel(info, recipe.digest(), inputs, [info, colors](auto in, float* out, int64_t count) {
    for (int64_t i = 0; i < count; i++, out += info.channels) {
      const float* pixel = in[0] + i * (colors + 1);
      const float weight = pixel[colors];
      if (colors < info.channels) out[colors] = weight;
      const bool is_seen = weight > (in.size() > 1 ? least_seen : 0);
      for (int c = 0; c < colors; c++) out[c] = is_seen ? pixel[c] / weight : 0;
      to_stored(info, out, 1);
      if (!is_seen && in.size() > 1) std::copy_n(in[1] + i * info.channels, colors, out);
    }
  });
}

ImagePtr resampled_by_weight(const ImagePtr& source, const ImagePtr& weights, Size size, const std::string& filter,
                             Outside outside, const Digest& recipe) {
  if (size == source->size()) return source;
  const ImagePtr plain = resampled(source, size, filter, outside, recipe);
  return unpremultiplied(
      resampled(premultiplied(source, weights), size, filter, outside, Hasher().add("weighted").add(recipe).digest()),
      plain->info(), plain);
}

}  // namespace terrazzo
