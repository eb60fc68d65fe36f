#include "core/picture/render/textures.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "core/base/portable_math.h"
#include "core/image/normal.h"
#include "core/image_io/color.h"

namespace terrazzo::render {

namespace {

/// Brings one texel, read from the map, into the space it is filtered in; in place.
using Decode = void (*)(float* texel, const ImageInfo& info);

void decode_vector(float* texel, const ImageInfo& info) {
  if (info.channels < 3) return;
  const Vector3f n = decode_normal(texel, info.normal_y);
  std::copy(n.begin(), n.end(), texel);
}

void decode_value(float*, const ImageInfo&) {}

/// The map averaged over whole blocks of `factor` x `factor` pixels (less at the right and bottom border).
Texture averaged(const Image& image, int factor, Decode decode, const Task& task) {
  const ImageInfo& info = image.info();
  const int c = info.channels;
  const Size size{(info.size.width + factor - 1) / factor, (info.size.height + factor - 1) / factor};
  std::vector<float> out(size_t(size.area()) * c, 0.f);
  tbb::parallel_for(0, size.height, [&](int row) {
    const CurrentTask scope(task);
    task.check();
    const Rect band{0, row * factor, info.size.width, std::min(factor, info.size.height - row * factor)};
    std::vector<float> in = image.read(band);
    float* sums = &out[size_t(row) * size.width * c];
    for (int y = 0; y < band.height; y++)
      for (int x = 0; x < band.width; x++) {
        float* texel = &in[(size_t(y) * band.width + x) * c];
        decode(texel, info);
        for (int k = 0; k < c; k++) sums[size_t(x / factor) * c + k] += texel[k];
      }
    for (int x = 0; x < size.width; x++) {
      const int columns = std::min(factor, info.size.width - x * factor);
      for (int k = 0; k < c; k++) sums[size_t(x) * c + k] /= float(columns * band.height);
    }
  });
  return Texture(size, c, std::move(out));
}

Texture load(const Material& material, Semantic semantic, int max_width, Decode decode, const Task& task) {
  const ImagePtr image = material.find(semantic);
  if (!image) return {};
  const ImagePtr decoded = is_color(semantic) ? convert_color(image, "lin_rec709") : image;
  return averaged(*decoded, std::max(1, image->width() / std::max(1, max_width)), decode, task);
}

/// The depth of the relief that explains the normals best: slopes summed over a few texels against differences of
/// height, along u and v (least squares through the origin). In widths of the material.
double depth_from_normals(const Texture& height, const Texture& normal, double aspect) {
  constexpr int span = 4;
  const Size size = height.size();
  const double across = 1.0 / size.width, down = aspect / size.height;  // of a texel, in widths of the material
  double covariance = 0, variance = 0;
  const auto add = [&](double rise, double difference) {
    covariance += rise * difference;
    variance += difference * difference;
  };
  const auto slope = [&](double x, double y) {
    const Vector3d n = normal.color(x / size.width, y / size.height);
    return Vector2d(Vector2d{-n.x(), n.y()} / std::max(0.1, n.z()));
  };
  for (int y = 0; y + span < size.height; y += 2)
    for (int x = 0; x + span < size.width; x += 2) {
      Vector2d rise;
      for (int k = 1; k <= span; k++)
        rise += Vector2d{slope(x + k, y + 0.5).x() * across, slope(x + 0.5, y + k).y() * down};
      const float here = *height.texel(x, y);
      add(rise.x(), *height.texel(x + span, y) - here);
      add(rise.y(), *height.texel(x, y + span) - here);
    }
  return variance > 0 ? std::clamp(covariance / variance, 0.0, 0.2) : 0;
}

/// Whether heights change across opposite borders hardly more than anywhere between adjacent lines inside.
bool goes_on(const Texture& height, bool columns) {
  const int lines = columns ? height.size().width : height.size().height;
  const int length = columns ? height.size().height : height.size().width;
  const auto step = [&](int i) {
    double sum = 0;
    for (int k = 0; k < length; k++)
      sum += std::abs(columns ? double(*height.texel(i, k)) - *height.texel(i - 1, k)
                              : double(*height.texel(k, i)) - *height.texel(k, i - 1));
    return sum;
  };
  double most_inside = 0;
  for (int i = 1; i < lines; i++) most_inside = std::max(most_inside, step(i));
  return step(0) <= 1.5 * most_inside;
}

Texture normals_of(const Texture& height, double depth, Outside outside) {
  const Size size = height.size();
  std::vector<float> values(size_t(size.area())), normals(values.size() * 3);
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) values[size_t(y) * size.width + x] = *height.texel(x, y);
  const ImageInfo info{.size = size, .channels = 1, .semantic = Semantic::height};
  normals_from_height(*Image::from_floats(info, std::move(values)), {0, 0, size.width, size.height}, depth * size.width,
                      SlopeFilter::central, outside, NormalY::up, normals.data());
  const ImageInfo made{.size = size, .channels = 3, .semantic = Semantic::normal};
  for (size_t i = 0; i < normals.size(); i += 3) decode_vector(&normals[i], made);
  return Texture(size, 3, std::move(normals));
}

}  // namespace

struct Texture::Blend {
  const float* texels[4];
  double weights[4];
};

Texture::Texture(Size size, int channels, std::vector<float> texels)
    : size_(size), channels_(channels), texels_(std::move(texels)) {}

const float* Texture::texel(int x, int y) const {
  return &texels_[(size_t(wrap(y, size_.height)) * size_.width + wrap(x, size_.width)) * channels_];
}

Texture::Blend Texture::blend(double u, double v) const {
  const double x = (u - double(portable::floor_int(u))) * size_.width - 0.5;
  const double y = (v - double(portable::floor_int(v))) * size_.height - 0.5;
  const int i = int(portable::floor_int(x)), j = int(portable::floor_int(y));
  const double tx = x - i, ty = y - j;
  const int x0 = i < 0 ? i + size_.width : i, x1 = i + 1 >= size_.width ? i + 1 - size_.width : i + 1;
  const int y0 = j < 0 ? j + size_.height : j, y1 = j + 1 >= size_.height ? j + 1 - size_.height : j + 1;
  const auto at = [&](int px, int py) { return &texels_[(size_t(py) * size_.width + px) * channels_]; };
  return {{at(x0, y0), at(x1, y0), at(x0, y1), at(x1, y1)},
          {(1 - tx) * (1 - ty), tx * (1 - ty), (1 - tx) * ty, tx * ty}};
}

Vector3d Texture::color(double u, double v) const {
  const Blend b = blend(u, v);
  const int green = channels_ >= 3 ? 1 : 0, blue = channels_ >= 3 ? 2 : 0;
  Vector3d sum;
  for (int k = 0; k < 4; k++) sum += Vector3d{b.texels[k][0], b.texels[k][green], b.texels[k][blue]} * b.weights[k];
  return sum;
}

double Texture::value(double u, double v) const {
  const Blend b = blend(u, v);
  double sum = 0;
  for (int k = 0; k < 4; k++) sum += b.texels[k][0] * b.weights[k];
  return sum;
}

ShadedPoint Textures::at(double u, double v) const {
  ShadedPoint p;
  if (!base_color.empty()) p.albedo = base_color.color(u, v);
  if (!normal.empty()) {
    const Vector3d n = normal.color(u, v);
    // Normals that point into the surface or have no length are ignored.
    if (n.z() > 0) p.normal = Vector3d{n.x(), n.y(), std::max(n.z(), 0.05)}.normalized();
  }
  if (!roughness.empty()) p.roughness = roughness.value(u, v);
  if (!metallic.empty()) p.metallic = std::clamp(metallic.value(u, v), 0.0, 1.0);
  if (!occlusion.empty()) p.occlusion = occlusion.value(u, v);
  if (!emission.empty()) p.emission = emission.color(u, v);
  return p;
}

double Textures::height_at(double u, double v, double u0, double v0) const {
  const auto within = [](double place, double at, int texels) {
    const auto first = double(portable::floor_int(at));
    return std::clamp(place, first + 0.5 / texels, first + 1 - 0.5 / texels);
  };
  if (!heights_repeat_x) u = within(u, u0, height.size().width);
  if (!heights_repeat_y) v = within(v, v0, height.size().height);
  return height.value(u, v);
}

Textures load_textures(const Material& material, int max_width, double relief, const Task& task) {
  Textures t;
  const auto get = [&](Semantic semantic, Decode decode) { return load(material, semantic, max_width, decode, task); };
  t.base_color = get(Semantic::base_color, decode_value);
  t.emission = get(Semantic::emission, decode_value);
  t.normal = get(Semantic::normal, decode_vector);
  t.height = get(Semantic::height, decode_value);
  t.roughness = get(Semantic::roughness, decode_value);
  t.metallic = get(Semantic::metallic, decode_value);
  t.occlusion = get(Semantic::ambient_occlusion, decode_value);
  t.aspect = double(material.size().height) / material.size().width;
  if (t.height.empty()) return t;
  t.heights_repeat_x = goes_on(t.height, true);
  t.heights_repeat_y = goes_on(t.height, false);
  if (!t.normal.empty()) {
    t.depth = depth_from_normals(t.height, t.normal, t.aspect) * relief;
  } else {
    t.depth = 0.05 * relief;
    const bool repeats = t.heights_repeat_x && t.heights_repeat_y;
    t.normal = normals_of(t.height, t.depth, repeats ? Outside::wrap : Outside::clamp);
  }
  return t;
}

}  // namespace terrazzo::render
