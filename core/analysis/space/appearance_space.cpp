#include "core/analysis/space/appearance_space.h"

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "core/analysis/space/likeness.h"
#include "core/analysis/space/mask_pyramid.h"
#include "core/analysis/space/planes.h"
#include "core/base/error.h"
#include "core/base/tuning.h"
#include "core/numeric/principal_components.h"
#include "core/numeric/weighted_row_sum.h"

namespace terrazzo {

namespace {

constexpr int radius = 2;
constexpr int side = 2 * radius + 1;
constexpr int window = side * side;

struct AppearanceSpaceTuning {
  double clipped = 5;
  int most_samples = 12000;
  int smallest_side = 16;
};
const Tunable<AppearanceSpaceTuning> appearance_space_tuning(
    "appearance_space",
    {
        {&AppearanceSpaceTuning::clipped, "clipped", "deviations",
         "of the first component, beyond which vectors are clipped. Higher: outliers differ from one another; lower: "
         "the usual is stored more finely",
         "What each rule decides", 1},
        {&AppearanceSpaceTuning::most_samples, "most_samples", "pixels",
         "of which components are learnt. Higher: rare features have a say; costs time",
         "not measured: bounds the time", 100},
        {&AppearanceSpaceTuning::smallest_side, "smallest_side", "pixels",
         "of the coarsest level, and of exemplars. Higher: coarse levels hold enough to choose from; lower: large "
         "features stay whole, where levels have too little texture left to tell one place from another",
         "initialize", 8},
    });

// exp(-r^2 / 3.18), a Gaussian of standard deviation 1.26 pixels, at squared distances 0, 1, 2, 4, 5, 8. Written out:
// no two libraries need agree on exp's last bit.
float window_weight(int dx, int dy) {
  switch (dx * dx + dy * dy) {
    case 0:
      return 1.0f;
    case 1:
      return 0.7302f;
    case 2:
      return 0.5332f;
    case 4:
      return 0.2843f;
    case 5:
      return 0.2076f;
    default:
      return 0.0808f;
  }
}

/// The weighted neighbourhood of a pixel: for each of 25 places, all channels.
void neighbourhood(const Planes& planes, int x, int y, float* out) {
  for (int j = -radius; j <= radius; j++)
    for (int i = -radius; i <= radius; i++) {
      const float w = window_weight(i, j);
      const float* v = planes.at(planes.column(x + i), planes.row(y + j));
      for (int c = 0; c < planes.channels; c++) *out++ = w * v[c];
    }
}

/// Those of `count` pixels side by side: the first number of each, then the second of each... `rows` is scratch space.
void neighbourhoods(const Planes& planes, int left, int y, int count, std::vector<float>& rows, float* out) {
  const int n = planes.channels, breadth = count + 2 * radius;
  // The neighbourhoods overlap: each channel's rows are brought together once.
  rows.resize(size_t(side) * n * breadth);
  for (int j = 0; j < side; j++)
    for (int p = 0; p < breadth; p++) {
      const float* v = planes.at(planes.column(left + p - radius), planes.row(y + j - radius));
      for (int c = 0; c < n; c++) rows[size_t(j * n + c) * breadth + p] = v[c];
    }
  for (int j = 0; j < side; j++)
    for (int i = 0; i < side; i++) {
      const float w = window_weight(i - radius, j - radius);
      for (int c = 0; c < n; c++, out += count) {
        const float* row = &rows[size_t(j * n + c) * breadth + i];
        for (int p = 0; p < count; p++) out[p] = w * row[p];
      }
    }
}

/// `usable`: the pixels whose neighbourhoods may be looked at; empty: all.
std::vector<float> samples_of(const Planes& planes, const std::vector<uint8_t>& usable, int n) {
  std::vector<size_t> places;
  for (size_t i = 0; i < usable.size(); i++)
    if (usable[i]) places.push_back(i);
  const size_t area = usable.empty() ? size_t(planes.size.area()) : places.size();
  const size_t count = std::min(area, size_t(appearance_space_tuning->most_samples));
  std::vector<float> samples(count * n);
  tbb::parallel_for(size_t{0}, count, [&](size_t s) {
    // One sample from each of `count` equal stretches of pixels, at a random place within it.
    const size_t begin = s * area / count, end = (s + 1) * area / count;
    const size_t drawn = begin + below(uint32_t(random_bits(planes.channels, s)), uint32_t(end - begin));
    const size_t at = usable.empty() ? drawn : places[drawn];
    neighbourhood(planes, int(at % planes.size.width), int(at / planes.size.width), &samples[s * n]);
  });
  return samples;
}

/// The factor that turns projections into integers: the first component's spread fills a fair part of the range, and
/// only outliers are clipped.
double integer_scale(const std::vector<float>& projected, double deviation) {
  float largest = 1e-12f;
  for (const float v : projected) largest = std::max(largest, std::abs(v));
  const double fitting = appearance_limit / double(largest);
  return deviation > 0 ? std::max(fitting, appearance_limit / (appearance_space_tuning->clipped * deviation)) : fitting;
}

/// What the level's basis makes of every pixel's neighbourhood of n numbers.
std::vector<float> projection(const Planes& planes, const AppearanceLevel& level, int n) {
  std::array<float, appearance_dimensions> offset{};
  for (int d = 0; d < level.dimensions; d++)
    for (int i = 0; i < n; i++) offset[d] += level.basis[size_t(d) * n + i] * level.mean[i];
  std::vector<float> projected(size_t(planes.size.area()) * appearance_dimensions);
  constexpr int strip = 32;  // pixels, side by side in memory
  tbb::parallel_for(0, planes.size.height, [&](int y) {
    std::vector<float> v(size_t(n) * strip), rows;
    for (int left = 0; left < planes.size.width; left += strip) {
      const int count = std::min(strip, planes.size.width - left);
      neighbourhoods(planes, left, y, count, rows, v.data());
      float* out = &projected[(size_t(y) * planes.size.width + left) * appearance_dimensions];
      for (int d = 0; d < level.dimensions; d++) {
        std::array<float, strip> sums{};
        weighted_row_sum(sums.data(), count, v.data(), size_t(count), &level.basis[size_t(d) * n], 1, size_t(n));
        for (int p = 0; p < count; p++) out[p * appearance_dimensions + d] = sums[p] - offset[d];
      }
    }
  });
  return projected;
}

AppearanceLevel make_level(const Planes& planes, std::vector<uint8_t> usable, const AppearanceOptions& options,
                           const Task& task) {
  const int n = window * planes.channels;
  PrincipalComponents pca = principal_components(samples_of(planes, usable, n), n, appearance_dimensions);
  task.check();
  AppearanceLevel level;
  level.size = planes.size;
  level.usable = std::move(usable);
  double kept = 0;
  const double wanted = options.retained_variance * pca.total_variance;
  for (const double v : pca.variances) {
    if (level.dimensions == options.dimensions || (level.dimensions > 0 && kept >= wanted)) break;
    kept += v;
    level.dimensions++;
  }
  level.retained = pca.total_variance > 0 ? std::min(1.0, kept / pca.total_variance) : 1.0;
  level.mean = std::move(pca.mean);
  level.basis.assign(pca.components.begin(), pca.components.begin() + size_t(level.dimensions) * n);

  const std::vector<float> projected = projection(planes, level, n);
  level.scale = integer_scale(projected, pca.variances.empty() ? 0 : std::sqrt(pca.variances[0]));
  level.vectors.resize(size_t(planes.size.area()));
  for (size_t i = 0; i < level.vectors.size(); i++)
    for (int d = 0; d < appearance_dimensions; d++) {
      const double v = std::floor(projected[i * appearance_dimensions + d] * level.scale + 0.5);
      level.vectors[i][d] = int16_t(std::clamp(v, -double(appearance_limit), double(appearance_limit)));
    }
  return level;
}

/// The features' channels with the guidance's behind them, scaled.
Planes joined(const Planes& features, const Planes& guidance, double weight) {
  Planes out{features.size, features.channels + guidance.channels, features.wraps, {}};
  out.values.reserve(size_t(out.size.area()) * out.channels);
  for (int64_t i = 0; i < out.size.area(); i++) {
    for (int c = 0; c < features.channels; c++) out.values.push_back(features.values[i * features.channels + c]);
    for (int c = 0; c < guidance.channels; c++)
      out.values.push_back(float(weight * guidance.values[i * guidance.channels + c]));
  }
  return out;
}

/// How the exemplar repeats, as far as the appearance can show it: where a mask or elements part it, streaks stay
/// whole.
Repeats repeats_shown(const Features& features) {
  Repeats repeats = features.repeats();
  if (features.mask() || features.elements()) repeats.streaks = {};
  return repeats;
}

}  // namespace

int appearance_levels(Size exemplar) {
  int count = 1;
  for (int side_length = std::min(exemplar.width, exemplar.height);
       side_length >= 2 * appearance_space_tuning->smallest_side; side_length = (side_length + 1) / 2)
    count++;
  return count;
}

void require_analysable(Size exemplar) {
  const int smallest_side = appearance_space_tuning->smallest_side;
  if (std::min(exemplar.width, exemplar.height) < smallest_side || std::max(exemplar.width, exemplar.height) > 65536)
    throw Error(fmt::format("the exemplar has {} pixels; it needs at least {} and at most 65536 a side",
                            describe(exemplar), smallest_side));
}

AppearancePtr make_appearance(const Features& features, const std::vector<ImagePtr>& guidance,
                              const AppearanceOptions& options, const Task& task) {
  const Size size = features.size();
  require_analysable(size);
  const Repeats repeats = repeats_shown(features);
  const Size finest = repeats.streaks.shortened(size);
  const int count = appearance_levels(finest);
  Planes planes = unmasked_planes(features, task);
  auto fingerprint = std::make_shared<Fingerprint>(fingerprint_of(features, planes));
  fill_masked(planes, features);
  Planes guides = guidance_planes(features, guidance, task);
  if (repeats.streaks.any()) {
    planes = shortened(planes, repeats.streaks);
    guides = shortened(guides, repeats.streaks);
  }
  const std::vector<uint8_t> allowed = allowed_pixels(features);
  std::vector<AppearanceLevel> levels;
  for (int l = 0; l < count; l++) {
    const double fade = count > 1 ? double(l) / (count - 1) : 1.0;
    const double weight = options.guidance_weight * fade;
    const bool guided = guides.channels > 0 && weight > 0;
    const Planes both = guided ? joined(planes, guides, weight) : Planes();
    levels.push_back(
        make_level(guided ? both : planes, usable_pixels(allowed, finest, l, features.wraps()), options, task));
    if (l + 1 < count) {
      planes = halved(planes);
      guides = halved(guides);
    }
    // Each level has a quarter of the pixels of the one before.
    task.progress(1 - 1.0 / double(int64_t{4} << (2 * l)));
  }
  return Appearance::make(std::move(levels), planes.channels + guides.channels, features.wraps(), repeats,
                          std::move(fingerprint), features.elements(), size);
}

}  // namespace terrazzo
