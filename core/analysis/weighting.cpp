#include "core/analysis/weighting.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/color.h"
#include "core/error.h"

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
  return Image::computed(info, recipe("unit normals", map), [map, flip](const Rect& r, float* out) {
    const int channels = map->channels();
    const std::vector<float> in = map->read(r);
    for (int64_t i = 0; i < r.area(); i++, out += 3) {
      const float x = in[i * channels] * 2 - 1, y = (in[i * channels + 1] * 2 - 1) * flip;
      const float squared = std::min(1.0f, x * x + y * y);
      out[0] = x;
      out[1] = y;
      out[2] = std::sqrt(1.0f - squared);
    }
  });
}

/// Nearest samples at another size: keeps maps of different sizes aligned.
ImagePtr at_size(const ImagePtr& map, Size size) {
  if (map->size() == size) return map;
  ImageInfo info = map->info();
  info.size = size;
  const Digest digest = Hasher().add("at size").add(map->digest()).add(size.width).add(size.height).digest();
  return Image::computed(info, digest, [map, size](const Rect& r, float* out) {
    const int n = map->channels();
    std::vector<float> row(size_t(map->width()) * n);
    for (int y = 0; y < r.height; y++) {
      map->read({0, int(int64_t{r.y + y} * map->height() / size.height), map->width(), 1}, row.data());
      for (int x = 0; x < r.width; x++, out += n)
        std::copy_n(&row[size_t(int64_t{r.x + x} * map->width() / size.width) * n], n, out);
    }
  });
}

/// Mean absolute difference between two lines of a map (rows or columns `a` and `b`).
double line_difference(const Image& map, bool rows, int a, int b) {
  const auto line = [&](int at) { return map.read(rows ? Rect{0, at, map.width(), 1} : Rect{at, 0, 1, map.height()}); };
  const std::vector<float> p = line(a), q = line(b);
  double sum = 0;
  for (size_t i = 0; i < p.size(); i++) sum += std::abs(double(p[i]) - q[i]);
  return sum / double(p.size());
}

bool borders_fit(const Image& map, bool rows) {
  const int n = rows ? map.height() : map.width();
  std::vector<double> inner;
  // A sample of lines is enough to know what neighbouring lines differ by.
  const int step = std::max(1, n / 64);
  for (int i = 0; i + 1 < n; i += step) inner.push_back(line_difference(map, rows, i, i + 1));
  std::sort(inner.begin(), inner.end());
  const double seam = line_difference(map, rows, n - 1, 0);
  return seam <= 1.6 * inner[inner.size() / 2] || seam <= inner[inner.size() * 97 / 100];
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

FeaturesPtr weighted_features(const Material& material, const NumberMap& weights, bool wraps) {
  for (const auto& [name, unused] : weights)
    if (!material.find(name))
      throw Error("weights", fmt::format("there is no map \"{}\"; the material has {}", name, material.map_names()));
  std::vector<FeatureImage> images;
  for (const Map& map : material.maps()) {
    const ImagePtr image = at_size(analysis_image(map.image), material.size());
    const auto given = weights.find(map.name);
    Numbers channel_weights =
        given != weights.end() ? given->second : Numbers{default_weight(map.image->info().semantic)};
    if (channel_weights.size() == 1) channel_weights.assign(image->channels(), channel_weights[0]);
    if (int(channel_weights.size()) != image->channels())
      throw Error("weights",
                  fmt::format("\"{}\" has {} channels in analysis space, but {} weights were given; give one or {}",
                              map.name, image->channels(), channel_weights.size(), image->channels()));
    // The alpha of a colour map is coverage, not colour: it counts only if it is asked for.
    if (given == weights.end() && image->channels() == 4) channel_weights[3] = 0;
    if (std::any_of(channel_weights.begin(), channel_weights.end(), [](double w) { return w > 0; }))
      images.push_back({image, channel_weights});
  }
  return Features::make(material.size(), std::move(images), wraps);
}

bool seems_to_tile(const Material& material) {
  return std::all_of(material.maps().begin(), material.maps().end(), [](const Map& map) {
    return map.image->width() > 1 && map.image->height() > 1 && borders_fit(*map.image, true) &&
           borders_fit(*map.image, false);
  });
}

}  // namespace terrazzo
