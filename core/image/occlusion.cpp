#include "core/image/occlusion.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace terrazzo {

namespace {

/// Unit vectors 22.5 degrees apart; the other half are their opposites.
constexpr std::array<std::array<double, 2>, 8> half_circle = {{{1, 0},
                                                               {0.9238795325112867, 0.3826834323650898},
                                                               {0.7071067811865476, 0.7071067811865476},
                                                               {0.3826834323650898, 0.9238795325112867},
                                                               {0, 1},
                                                               {-0.3826834323650898, 0.9238795325112867},
                                                               {-0.7071067811865476, 0.7071067811865476},
                                                               {-0.9238795325112867, 0.3826834323650898}}};
constexpr int directions = 2 * int(half_circle.size());

/// A pixel on the way to the horizon, and what a height difference to it counts as a slope.
struct Step {
  int x = 0;
  int y = 0;
  float slope_per_height = 0;
};

std::vector<Step> steps_along(double dx, double dy, const OcclusionOptions& options) {
  std::vector<Step> steps;
  for (int i = 1; i <= options.radius; i++) {
    const Step step{int(std::lround(dx * i)), int(std::lround(dy * i)), 0};
    const double distance = std::sqrt(double(step.x) * step.x + double(step.y) * step.y);
    const double part = distance / (options.radius + 1);
    if (part >= 1) continue;
    steps.push_back({step.x, step.y, float(options.height_scale * (1 - part * part) / distance)});
  }
  return steps;
}

void raise_horizon(const float* here, const float* there, float slope_per_height, int count, float* slope) {
  for (int x = 0; x < count; x++) slope[x] = std::max(slope[x], (there[x] - here[x]) * slope_per_height);
}

}  // namespace

void occlusion_from_height(const PixelView& height, const Rect& region, const OcclusionOptions& options, float* out) {
  const int apron = options.radius;
  const Rect around = grown(region, apron);
  const std::vector<float> h = read_padded(height, around, options.outside);
  std::array<std::vector<Step>, directions> steps;
  for (size_t d = 0; d < half_circle.size(); d++) {
    const auto [dx, dy] = half_circle[d];
    steps[2 * d] = steps_along(dx, dy, options);
    steps[2 * d + 1] = steps_along(-dx, -dy, options);
  }
  const float strength = static_cast<float>(options.strength);
  std::vector<float> slope(region.width), seen(region.width);
  for (int y = 0; y < region.height; y++) {
    const float* here = &h[size_t(y + apron) * around.width + apron];
    std::fill(seen.begin(), seen.end(), 0.0f);
    for (const std::vector<Step>& direction : steps) {
      std::fill(slope.begin(), slope.end(), 0.0f);
      for (const Step& s : direction)
        raise_horizon(here, here + ptrdiff_t{s.y} * around.width + s.x, s.slope_per_height, region.width, slope.data());
      for (int x = 0; x < region.width; x++) seen[x] += 1 / (1 + slope[x] * slope[x]);
    }
    for (int x = 0; x < region.width; x++)
      out[size_t(y) * region.width + x] = std::clamp(1 - strength * (1 - seen[x] / directions), 0.0f, 1.0f);
  }
}

}  // namespace terrazzo
