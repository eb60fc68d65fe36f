#include "core/filter/occlusion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/portable_math.h"
#include "core/image/normal.h"

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

/// A pixel on the way to the horizon, and the factor from a height difference to a slope.
struct Step {
  int x = 0;
  int y = 0;
  float slope_per_height = 0;
};

std::vector<Step> steps_along(double dx, double dy, const HorizonOptions& options) {
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

/// The horizons of the points of a region.
class Horizons {
 public:
  Horizons(const PixelView& height, const Rect& region, const HorizonOptions& options)
      : apron_(options.radius),
        width_(region.width),
        stride_(grown(region, apron_).width),
        heights_(read_padded(height, grown(region, apron_), options.outside)),
        slopes_(size_t(region.width)) {
    for (const auto& [dx, dy] : half_circle)
      for (const double sign : {1.0, -1.0})
        directions_.push_back({sign * dx, sign * dy, steps_along(sign * dx, sign * dy, options)});
  }

  /// Calls visit(dx, dy, slopes) for each direction, with the slopes from the points of a row up to the horizon.
  template <typename Visit>
  void for_directions(int row, const Visit& visit) {
    const float* here = &heights_[size_t(row + apron_) * stride_ + apron_];
    for (const Direction& d : directions_) {
      std::fill(slopes_.begin(), slopes_.end(), 0.0f);
      for (const Step& s : d.steps)
        raise_horizon(here, here + ptrdiff_t{s.y} * stride_ + s.x, s.slope_per_height, width_, slopes_.data());
      visit(d.x, d.y, slopes_.data());
    }
  }

 private:
  struct Direction {
    double x, y;
    std::vector<Step> steps;
  };
  int apron_, width_, stride_;
  std::vector<float> heights_, slopes_;
  std::vector<Direction> directions_;
};

/// The sum of the directions between the zenith and a horizon of slope t, within a narrow wedge.
struct Wedge {
  double outwards, upwards;
};

Wedge wedge_above(double t, SkyWeight weight) {
  const double sine = 1 / std::sqrt(1 + t * t), cosine = t * sine;  // of the angle between zenith and horizon
  if (weight == SkyWeight::cosine) return {sine * sine * sine / 3, (1 - cosine * cosine * cosine) / 3};
  return {(portable::atan2(1, t) - sine * cosine) / 2, sine * sine / 2};
}

}  // namespace

void occlusion_from_height(const PixelView& height, const Rect& region, const HorizonOptions& options, double strength,
                           float* out) {
  Horizons horizons(height, region, options);
  const float factor = static_cast<float>(strength);
  std::vector<float> seen(size_t(region.width));
  for (int y = 0; y < region.height; y++) {
    std::fill(seen.begin(), seen.end(), 0.0f);
    horizons.for_directions(y, [&](double, double, const float* slope) {
      for (size_t x = 0; x < seen.size(); x++) seen[x] += 1 / (1 + slope[x] * slope[x]);
    });
    for (const float part : seen) *out++ = std::clamp(1 - factor * (1 - part / directions), 0.0f, 1.0f);
  }
}

void bent_normals_from_height(const PixelView& height, const Rect& region, const HorizonOptions& options,
                              SkyWeight weight, NormalY normal_y, float* out) {
  Horizons horizons(height, region, options);
  std::vector<Vector3d> sums(size_t(region.width));
  for (int y = 0; y < region.height; y++) {
    std::fill(sums.begin(), sums.end(), Vector3d(0, 0, 0));
    horizons.for_directions(y, [&](double dx, double dy, const float* slope) {
      for (size_t x = 0; x < sums.size(); x++) {
        const Wedge wedge = wedge_above(slope[x], weight);
        sums[x] += Vector3d(dx * wedge.outwards, -dy * wedge.outwards, wedge.upwards);
      }
    });
    for (const Vector3d& sum : sums) {
      encode_normal(normalized(sum.cast<float>()), normal_y, out);
      out += 3;
    }
  }
}

}  // namespace terrazzo
