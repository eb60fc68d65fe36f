#include "core/analysis/space/weighting.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image/image_facts.h"
#include "core/image/image_ops.h"
#include "core/image_io/color.h"
#include "core/material/map_names.h"

namespace terrazzo {

namespace {

Digest recipe(const char* what, const ImagePtr& image) {
  return Hasher().add(what).add(image->digest()).digest();
}

/// Encoded normals as vectors; the third component is made anew from the other two.
ImagePtr unit_normals(const ImagePtr& map) {
  ImageInfo info = map->info();
  info.normal_y = NormalY::up;
  info.channels = 3;
  const float flip = map->info().normal_y == NormalY::down ? -1.0f : 1.0f;
  const int channels = map->channels();
  return pixel_by_pixel(info, recipe("unit normals", map), {map}, [=](auto in, float* out, int64_t count) {
    for (int64_t i = 0; i < count; i++, out += 3) {
      const float x = in[0][i * channels] * 2 - 1, y = (in[0][i * channels + 1] * 2 - 1) * flip;
      const float squared = std::min(1.0f, x * x + y * y);
      out[0] = x;
      out[1] = y;
      out[2] = std::sqrt(1.0f - squared);
    }
  });
}

}  // namespace

ImagePtr analysis_image(const ImagePtr& map) {
  if (is_color(map->info().semantic)) return to_oklab(map);
  return map->info().semantic == Semantic::normal && map->channels() >= 2 ? unit_normals(map) : map;
}

double default_weight(Semantic semantic) {
  switch (semantic) {
    case Semantic::base_color:
      return 1;
    case Semantic::height:
      return 0.7;
    case Semantic::normal:
      return 0.5;
    case Semantic::roughness:
      return 0.3;
    case Semantic::metallic:
      return 0.5;
    case Semantic::opacity:
      return 0.7;
    case Semantic::emission:
      return 0.5;
    case Semantic::specular:
      return 0.3;
    case Semantic::mask:
      return 0.5;
    case Semantic::ambient_occlusion:
      return 0.3;
    case Semantic::guidance:
    case Semantic::data:
      return 0;
  }
  return 0;
}

FeaturesPtr weighted_features(const Material& material, const NumberMap& weights, bool wraps, const ImagePtr& mask) {
  if (mask) require_shape("mask", *mask, "the exemplar", material.size());
  std::vector<std::string> weighted;
  for (const auto& [name, unused] : weights) weighted.push_back(name);
  require_maps("weights", weighted, names_of(material.maps()));
  std::vector<FeatureImage> images;
  for (const Map& map : material.maps()) {
    const ImagePtr image = nearest_at_size(analysis_image(map.image), material.size());
    const auto given = weights.find(map.name);
    Numbers channel_weights =
        given != weights.end() ? given->second : Numbers{default_weight(map.image->info().semantic)};
    if (channel_weights.size() == 1) channel_weights.assign(image->channels(), channel_weights[0]);
    if (int(channel_weights.size()) != image->channels())
      throw Error("weights", fmt::format("\"{}\" has {} in analysis space, but {} weights were given; give {}",
                                         map.name, counted(image->channels(), "channel"), channel_weights.size(),
                                         image->channels() == 1 ? "one" : fmt::format("one or {}", image->channels())));
    // The alpha of a colour map is coverage, not colour: it counts only if it is asked for.
    if (given == weights.end() && image->channels() == 4) channel_weights[3] = 0;
    if (std::any_of(channel_weights.begin(), channel_weights.end(), [](double w) { return w > 0; }))
      images.push_back({image, channel_weights, map.name});
  }
  return Features::make(material.size(), std::move(images), wraps, {},
                        mask ? nearest_at_size(mask, material.size()) : nullptr);
}

NumberMap weights_of_chosen(const Material& material, const std::vector<std::string>& maps) {
  require_maps("maps", maps, names_of(material.maps()));
  NumberMap weights;
  const bool any_counts = std::any_of(material.maps().begin(), material.maps().end(),
                                      [](const Map& map) { return default_weight(map.image->info().semantic) > 0; });
  if (maps.empty() && any_counts) return weights;
  for (const Map& map : material.maps())
    weights[map.name] = {maps.empty() || std::find(maps.begin(), maps.end(), map.name) != maps.end() ? 1.0 : 0.0};
  return weights;
}

}  // namespace terrazzo
