#include "core/procedural/finish.h"

#include <cmath>

#include <tbb/parallel_for.h>

#include "core/procedural/exact_math.h"

namespace terrazzo {

namespace {

constexpr int samples = 2;  // per pixel, across and down

/// A row or column inside the image.
int inside(int v, int n, bool wraps) {
  return wraps ? wrap(v, n) : std::clamp(v, 0, n - 1);
}

float rounded(double value, int steps) {
  return float(exact::floor_int(exact::saturate(value) * steps + 0.5)) / float(steps);
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
          sum.height += exact::saturate(p.height);
          sum.roughness += exact::saturate(p.roughness);
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

struct Offset {
  int x, y;
  float per_distance;
};

std::vector<std::vector<Offset>> horizon_offsets(double relief, double reach) {
  constexpr int directions = 16;
  std::vector<std::vector<Offset>> all(directions);
  for (int k = 0; k < directions; k++)
    for (double distance = 1; distance <= std::max(2.0, reach); distance = distance * 1.35 + 0.5) {
      const double turns = (k + 0.5) / directions;
      const int x = int(exact::floor_int(exact::cos_turns(turns) * distance + 0.5));
      const int y = int(exact::floor_int(exact::sin_turns(turns) * distance + 0.5));
      const double length = std::sqrt(double(x * x + y * y));
      if (length > 0) all[k].push_back({x, y, float(relief / length)});
    }
  return all;
}

}  // namespace

std::vector<float> normals_of(const std::vector<float>& height, Size size, bool wraps, double relief) {
  std::vector<float> out(size_t(size.area()) * 3);
  tbb::parallel_for(0, size.height, [&](int y) {
    const auto at = [&](int px, int py) {
      return double(height[size_t(inside(py, size.height, wraps)) * size.width + inside(px, size.width, wraps)]);
    };
    for (int x = 0; x < size.width; x++) {
      const double nx = (at(x - 1, y) - at(x + 1, y)) * 0.5 * relief;
      const double ny = (at(x, y + 1) - at(x, y - 1)) * 0.5 * relief;
      const double length = std::sqrt(nx * nx + ny * ny + 1);
      float* n = &out[(size_t(y) * size.width + x) * 3];
      n[0] = float(nx / length * 0.5 + 0.5);
      n[1] = float(ny / length * 0.5 + 0.5);
      n[2] = float(1 / length * 0.5 + 0.5);
    }
  });
  return out;
}

std::vector<float> horizon_occlusion(const std::vector<float>& height, Size size, bool wraps, double relief,
                                     double reach, const Task& task) {
  const std::vector<std::vector<Offset>> directions = horizon_offsets(relief, reach);
  std::vector<float> out(size_t(size.area()));
  tbb::parallel_for(0, size.height, [&](int y) {
    task.check();
    for (int x = 0; x < size.width; x++) {
      const float here = height[size_t(y) * size.width + x];
      float open = 0;
      for (const std::vector<Offset>& steps : directions) {
        float steepest = 0;
        for (const Offset& o : steps) {
          const int px = inside(x + o.x, size.width, wraps), py = inside(y + o.y, size.height, wraps);
          steepest = std::max(steepest, (height[size_t(py) * size.width + px] - here) * o.per_distance);
        }
        // The horizon at tangent t hides sin^2 = t^2 / (1 + t^2) of a cosine-weighted slice of sky.
        open += 1 / (1 + steepest * steepest);
      }
      out[size_t(y) * size.width + x] = open / float(directions.size());
    }
  });
  return out;
}

MaterialPtr finished_material(const std::string& name, const Surface& surface, const Finish& finish, const Task& task) {
  Sampled s = sample(surface, finish.size, task);
  task.progress(0.7);
  std::vector<float> normal = normals_of(s.height, finish.size, finish.wraps, finish.relief);
  for (float& v : normal) v = rounded(v, 255);
  task.progress(0.8);
  std::vector<float> occlusion =
      horizon_occlusion(s.height, finish.size, finish.wraps, finish.relief, finish.reach, task);
  for (size_t i = 0; i < occlusion.size(); i++) {
    const double shade = 1 - finish.cavity * (1 - double(occlusion[i]));
    for (int c = 0; c < 3; c++) s.color[i * 3 + c] = rounded(s.color[i * 3 + c] * shade, 255);
    occlusion[i] = rounded(occlusion[i], 255);
  }
  const auto image = [&](int channels, Semantic semantic, Depth depth, std::vector<float> pixels) {
    ImageInfo info{.size = finish.size, .channels = channels, .semantic = semantic, .depth = depth};
    if (semantic == Semantic::base_color) info.color_space = "srgb_texture";
    return Map{std::string(name_of(semantic)), Image::from_floats(info, std::move(pixels))};
  };
  return Material::make(name, {image(3, Semantic::base_color, Depth::u8, std::move(s.color)),
                               image(3, Semantic::normal, Depth::u8, std::move(normal)),
                               image(1, Semantic::height, Depth::u16, std::move(s.height)),
                               image(1, Semantic::roughness, Depth::u8, std::move(s.roughness)),
                               image(1, Semantic::ambient_occlusion, Depth::u8, std::move(occlusion))});
}

}  // namespace terrazzo
