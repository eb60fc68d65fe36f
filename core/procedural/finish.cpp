#include "core/procedural/finish.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "core/base/portable_math.h"
#include "core/filter/occlusion.h"
#include "core/image/normal.h"

namespace terrazzo {

namespace {

constexpr int samples = 2;  // per pixel and axis

float rounded(double value, int steps) {
  return float(portable::floor_int(portable::saturate(value) * steps + 0.5)) / float(steps);
}

struct Sampled {
  std::vector<float> height, roughness, color;
};

Sampled sample(const Surface& surface, Size size, const Task& task) {
  const size_t area = size_t(size.area());
  Sampled s{std::vector<float>(area), std::vector<float>(area), std::vector<float>(area * 3)};
  const double step = 1.0 / (double(size.width) * samples);
  tbb::parallel_for(0, size.height, [&](int y) {
    task.check();
    for (int x = 0; x < size.width; x++) {
      SurfacePoint sum{.height = 0, .color = {}, .roughness = 0};
      for (int j = 0; j < samples; j++)
        for (int i = 0; i < samples; i++) {
          const SurfacePoint p = surface.at((x * samples + i + 0.5) * step, (y * samples + j + 0.5) * step);
          sum.height += portable::saturate(p.height);
          sum.roughness += portable::saturate(p.roughness);
          sum.color = sum.color + p.color;
        }
      constexpr double share = 1.0 / (samples * samples);
      const size_t at = size_t(y) * size.width + x;
      s.height[at] = rounded(sum.height * share, 65535);
      s.roughness[at] = rounded(sum.roughness * share, 255);
      s.color[at * 3] = float(sum.color.r * share);
      s.color[at * 3 + 1] = float(sum.color.g * share);
      s.color[at * 3 + 2] = float(sum.color.b * share);
    }
  });
  return s;
}

void round_all(std::vector<float>& values, int steps) {
  for (float& v : values) v = rounded(v, steps);
}

/// One float per pixel and channel; `make` computes them region by region, in parallel.
template <typename Make>
std::vector<float> computed(Size size, int channels, const Task& task, const Make& make) {
  const ImageInfo info{.size = size, .channels = channels, .semantic = Semantic::data};
  return materialized(Image::computed(info, Digest(), make), task)->pixels();
}

}  // namespace

MaterialPtr finished_material(const std::string& name, const Surface& surface, const Finish& finish, const Task& task) {
  Sampled s = sample(surface, finish.size, task);
  task.progress(0.7);
  const auto image = [&](int channels, Semantic semantic, Depth depth, std::vector<float> pixels) {
    ImageInfo info{.size = finish.size, .channels = channels, .semantic = semantic, .depth = depth};
    if (semantic == Semantic::base_color) info.color_space = "srgb_texture";
    return Image::from_floats(info, std::move(pixels));
  };
  const ImagePtr height = image(1, Semantic::height, Depth::u16, std::move(s.height));
  const Outside outside = finish.wraps ? Outside::wrap : Outside::clamp;
  std::vector<float> normal = computed(finish.size, 3, task, [&](const Rect& region, float* out) {
    normals_from_height(*height, region, finish.relief, SlopeFilter::central, outside, NormalY::up, out);
  });
  round_all(normal, 255);
  task.progress(0.8);
  const HorizonOptions options{
      .height_scale = finish.relief, .radius = std::max(1, int(finish.reach)), .outside = outside};
  std::vector<float> occlusion = computed(finish.size, 1, task, [&](const Rect& region, float* out) {
    occlusion_from_height(*height, region, options, 1, out);
  });
  for (size_t i = 0; i < occlusion.size(); i++) {
    const double shade = 1 - finish.cavity * (1 - double(occlusion[i]));
    for (int c = 0; c < 3; c++) s.color[i * 3 + c] = rounded(s.color[i * 3 + c] * shade, 255);
  }
  round_all(occlusion, 255);
  std::vector<Map> maps;
  for (const ImagePtr& map : {image(3, Semantic::base_color, Depth::u8, std::move(s.color)),
                              image(3, Semantic::normal, Depth::u8, std::move(normal)), height,
                              image(1, Semantic::roughness, Depth::u8, std::move(s.roughness)),
                              image(1, Semantic::ambient_occlusion, Depth::u8, std::move(occlusion))})
    maps.push_back({std::string(name_of(map->info().semantic)), map});
  return Material::make(name, std::move(maps));
}

}  // namespace terrazzo
