#include "core/picture/render/preview.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <tbb/parallel_for.h>

#include "core/base/portable_math.h"
#include "core/image/srgb.h"
#include "core/picture/contact_sheet.h"
#include "core/picture/render/relief.h"
#include "core/picture/render/shading.h"
#include "core/picture/render/textures.h"

namespace terrazzo {

namespace {

using namespace render;

/// Where a ray meets the shape: the place on the material and the frame of the surface there.
struct Hit {
  double x = 0, y = 0;  ///< in widths of the material, y downwards
  Vector3d tangent{1, 0, 0}, bitangent{0, 1, 0}, normal{0, 0, 1};
  Vector3d view{0, 0, 1};
};

/// The part of the rays of one picture that depends on the shape. `x`, `y`: pixels, not necessarily at centres.
class Camera {
 public:
  Camera(const PreviewSpec& spec, double aspect) : spec_(spec), aspect_(aspect) {}

  std::optional<Hit> hit(double x, double y) const {
    return spec_.shape == PreviewShape::plane ? on_plane(x, y) : on_sphere(x, y);
  }

 private:
  Hit on_plane(double x, double y) const {
    const double turns = spec_.tilt / 360, c = portable::cos_turns(turns), s = portable::sin_turns(turns);
    Hit h;
    const double middle = 0.5 * spec_.size.height;
    h.x = x / spec_.size.width * spec_.tile;
    h.y = (middle + (y - middle) / c) / spec_.size.width * spec_.tile;
    h.bitangent = {0, c, -s};
    h.normal = {0, s, c};
    return h;
  }

  std::optional<Hit> on_sphere(double x, double y) const {
    // The ball's outline is seen at asin(1 / distance); let it fill nine tenths of the shorter side.
    const double d = spec_.distance, outline = 1 / std::sqrt(d * d - 1);
    const double half = 0.5 * std::min(spec_.size.width, spec_.size.height);
    const double scale = outline / (0.9 * half);
    const Vector3d ray =
        Vector3d{(x - 0.5 * spec_.size.width) * scale, (0.5 * spec_.size.height - y) * scale, -1}.normalized();
    const double b = -ray.z() * d, disc = b * b - (d * d - 1);
    if (disc < 0) return std::nullopt;
    Hit h;
    h.normal = Vector3d{0, 0, d} + ray * (b - std::sqrt(disc));
    h.view = -ray;
    // Unrolled from the point that faces the viewer; the frame turns along with the surface.
    const Vector3d& n = h.normal;
    const double sine = n.head<2>().norm();
    const double arc = sine > 1e-6 ? portable::atan2(sine, n.z()) / sine : 1;
    const double per_radius = spec_.tile / 3.14159265358979324;
    h.x = 0.5 + n.x() * arc * per_radius;
    h.y = 0.5 * aspect_ - n.y() * arc * per_radius;
    const double k = 1 / (1 + n.z());
    h.tangent = {1 - n.x() * n.x() * k, -n.x() * n.y() * k, -n.x()};
    h.bitangent = {-n.x() * n.y() * k, 1 - n.y() * n.y() * k, -n.y()};
    return h;
  }

  const PreviewSpec& spec_;
  double aspect_;
};

class Renderer {
 public:
  Renderer(const PreviewSpec& spec, const Textures& textures)
      : spec_(spec), textures_(textures), camera_(spec, textures.aspect), stops_(portable::exp2(spec.exposure)) {
    for (const double azimuth : spec.lights) {
      const double flat = portable::cos_turns(spec.elevation / 360);
      lights_.push_back({flat * portable::cos_turns(azimuth / 360), flat * portable::sin_turns(azimuth / 360),
                         portable::sin_turns(spec.elevation / 360)});
    }
    const double* b = spec.background;
    background_ = {decode_srgb(b[0]), decode_srgb(b[1]), decode_srgb(b[2])};
  }

  /// Display-linear colour of a pixel under one light.
  Vector3d pixel(int x, int y, size_t light) const {
    const bool flat = spec_.shape == PreviewShape::plane && spec_.tilt == 0;
    const int samples = flat ? 1 : 2;
    Vector3d sum;
    for (int j = 0; j < samples; j++)
      for (int i = 0; i < samples; i++) {
        const std::optional<Hit> hit = camera_.hit(x + (i + 0.5) / samples, y + (j + 0.5) / samples);
        sum += hit ? tone_mapped(shade(*hit, lights_[light]) * stops_) : background_;
      }
    return sum * (1.0 / (samples * samples));
  }

 private:
  Vector3d shade(const Hit& hit, const Vector3d& light) const {
    const auto local = [&](const Vector3d& v) {
      return Vector3d{v.dot(hit.tangent), v.dot(hit.bitangent), v.dot(hit.normal)};
    };
    const Vector3d view = local(hit.view), to_light = local(light);
    const ReliefPoint at = visible_point(textures_, hit.x, hit.y, view);
    const ShadedPoint p = textures_.at(at.x, at.y / textures_.aspect);
    Vector3d color = reflected_ambient(p, view, local({0, 1, 0})) * spec_.ambient + p.emission;
    if (to_light.z() > 0)
      color += reflected(p, view, to_light) * (spec_.intensity * light_reaching(textures_, at, to_light));
    return color;
  }

  const PreviewSpec& spec_;
  const Textures& textures_;
  Camera camera_;
  double stops_;
  std::vector<Vector3d> lights_;
  Vector3d background_;
};

float stored(double linear) {
  return float(portable::floor_int(portable::saturate(encode_srgb(linear)) * 255 + 0.5)) / 255.0f;
}

ImagePtr rendered(const Renderer& renderer, Size size, size_t light, const Task& task) {
  std::vector<float> out(size_t(size.area()) * 3);
  tbb::parallel_for(0, size.height, [&](int y) {
    task.check();
    for (int x = 0; x < size.width; x++) {
      const Vector3d c = renderer.pixel(x, y, light);
      float* pixel = &out[(size_t(y) * size.width + x) * 3];
      pixel[0] = stored(c.x());
      pixel[1] = stored(c.y());
      pixel[2] = stored(c.z());
    }
  });
  ImageInfo info{.size = size, .channels = 3, .semantic = Semantic::base_color, .depth = Depth::u8};
  info.color_space = "srgb_texture";
  return Image::from_floats(info, std::move(out));
}

/// Pictures row by row, in as square a sheet as possible.
ImagePtr sheet_of(const std::vector<ImagePtr>& pictures) {
  size_t columns = 1;
  while (columns * columns < pictures.size()) columns++;
  std::vector<std::vector<ImagePtr>> rows;
  for (size_t i = 0; i < pictures.size(); i++) {
    if (i % columns == 0) rows.emplace_back();
    rows.back().push_back(pictures[i]);
  }
  return contact_sheet(rows, std::numeric_limits<int>::max());
}

}  // namespace

Size completed(Size size, PreviewShape shape, Size material) {
  if (shape == PreviewShape::sphere) material = {1, 1};
  const auto other = [](int side, int of, int to) {
    return std::clamp(int(std::lround(double(side) * to / of)), 1, largest_preview);
  };
  if (size.height == 0) size.height = other(size.width, material.width, material.height);
  if (size.width == 0) size.width = other(size.height, material.height, material.width);
  return size;
}

ImagePtr render_preview(const Material& material, const PreviewSpec& spec, const Task& task) {
  Textures textures =
      load_textures(material, int(std::max(1.0, spec.size.width / std::max(spec.tile, 1e-3))), spec.relief, task);
  // A tilted view shows the sides of such cliffs.
  if (spec.shape != PreviewShape::plane || spec.tilt != 0) textures.heights_repeat_x = textures.heights_repeat_y = true;
  const Renderer renderer(spec, textures);
  std::vector<ImagePtr> pictures;
  for (size_t light = 0; light < spec.lights.size(); light++)
    pictures.push_back(rendered(renderer, spec.size, light, task));
  return pictures.size() == 1 ? pictures.front() : sheet_of(pictures);
}

}  // namespace terrazzo
