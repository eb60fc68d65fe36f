#include "core/analysis/space/planes.h"

#include <cmath>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "core/analysis/space/mask_pyramid.h"
#include "core/base/error.h"
#include "core/base/tuning.h"
#include "core/numeric/distance_transform.h"
#include "core/numeric/moments.h"
#include "core/numeric/principal_components.h"

namespace terrazzo {

namespace {

struct PlanesTuning {
  double least_deviation = 0.02;
};
const Tunable<PlanesTuning> planes_tuning(
    "planes", {
                  {&PlanesTuning::least_deviation, "least_deviation", "of the range of values",
                   "to which maps that hardly vary are scaled. Higher: faint maps count for less; "
                   "lower: their noise counts as much as the structure of others",
                   "not measured: less is quantisation noise of an 8-bit map rather than structure", 0.000001},
              });

/// Copies an image's channels into the planes from channel `first` on.
void copy_channels(const Image& image, const std::vector<int>& channels, Planes& planes, int first, const Task& task) {
  constexpr int rows = 16;  // a megabyte or two
  for_each_strip_at_once(image, rows, task, [&](const Rect& r, const float* v) {
    for (int y = r.y; y < r.bottom(); y++)
      for (int x = 0; x < r.width; x++, v += image.channels()) {
        float* out = planes.at(x, y) + first;
        for (const int c : channels) *out++ = v[c];
      }
  });
}

/// Writes an image's weighted channels into the planes from channel `first` on. `allowed`: the pixels that count;
/// empty: all.
void add_image(const Image& image, const std::vector<double>& weights, const std::vector<uint8_t>& allowed,
               Planes& planes, int first, const Task& task) {
  std::vector<int> channels;
  for (int c = 0; c < image.channels(); c++)
    if (weights[c] > 0) channels.push_back(c);
  copy_channels(image, channels, planes, first, task);
  std::vector<Moments<1>> moments(channels.size());
  const auto area = size_t(planes.size.area());
  for (size_t i = 0; i < area; i++)
    if (allowed.empty() || allowed[i])
      for (size_t k = 0; k < channels.size(); k++)
        moments[k].add(double(planes.values[i * planes.channels + first + k]));
  double variance = 0;
  for (const Moments<1>& m : moments) variance += m.variance();
  const double unit = 1.0 / std::max(std::sqrt(variance), planes_tuning->least_deviation);
  tbb::parallel_for(tbb::blocked_range<size_t>(0, area), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t k = 0; k < channels.size(); k++) {
      const double mean = moments[k].mean(), factor = weights[channels[k]] * unit;
      float* v = &planes.values[range.begin() * planes.channels + first + k];
      for (size_t i = range.begin(); i < range.end(); i++, v += planes.channels) *v = float((*v - mean) * factor);
    }
  });
}

}  // namespace

void fill_masked(Planes& planes, const Features& features) {
  const std::vector<uint8_t> allowed = allowed_pixels(features);
  if (allowed.empty() || planes.channels == 0) return;
  const std::vector<uint32_t> nearest = nearest_set(allowed, planes.size, planes.wraps);
  const int n = planes.channels;
  for (size_t i = 0; i < nearest.size(); i++)
    if (!allowed[i]) std::copy_n(&planes.values[size_t(nearest[i]) * n], n, &planes.values[i * n]);
}

Planes unmasked_planes(const Features& features, const Task& task) {
  const std::vector<uint8_t> allowed = allowed_pixels(features);
  Planes planes = Planes::zeros(features.size(), features.channel_count(), features.wraps());
  int first = 0;
  for (const FeatureImage& f : features.images()) {
    task.check();
    add_image(*f.image, f.weights, allowed, planes, first, task);
    for (const double w : f.weights) first += w > 0;
  }
  return planes;
}

std::shared_ptr<const Planes> weighted_planes(const Features& features, const Task& task) {
  HeldPlanes& held = features.held_planes();
  // Not locked while they are made: the thread may meanwhile take up another task that asks for them.
  {
    const std::lock_guard lock(held.mutex);
    if (auto planes = held.planes.lock()) return planes;
  }
  auto planes = std::make_shared<Planes>(unmasked_planes(features, task));
  fill_masked(*planes, features);
  const std::lock_guard lock(held.mutex);
  held.planes = planes;
  return planes;
}

void require_guidance(const ImageFacts& image, std::optional<Size> features) {
  if (!image.size || !features || *image.size == *features) return;
  throw Error("guidance", fmt::format("expected an image of the features' size, {}, found {}; put \"resize\" before it",
                                      describe(*features), describe(*image.size)));
}

Planes guidance_planes(const Features& features, const std::vector<ImagePtr>& guidance, const Task& task) {
  const Size size = features.size();
  const std::vector<uint8_t> allowed = allowed_pixels(features);
  int channels = 0;
  for (const ImagePtr& g : guidance) {
    require_guidance(facts_of(g->info()), size);
    channels += g->channels();
  }
  Planes planes = Planes::zeros(size, channels, features.wraps());
  int first = 0;
  for (const ImagePtr& g : guidance) {
    task.check();
    add_image(*g, std::vector<double>(g->channels(), 1.0), allowed, planes, first, task);
    first += g->channels();
  }
  fill_masked(planes, features);
  return planes;
}

Planes cropped(const Planes& planes, const Rect& part) {
  Planes out = Planes::zeros({part.width, part.height}, planes.channels, planes.wraps && part == whole(planes.size));
  for (int y = 0; y < part.height; y++)
    std::copy_n(planes.at(part.x, part.y + y), size_t(part.width) * planes.channels, out.at(0, y));
  return out;
}

Planes halved(const Planes& in) {
  const Size size{(in.size.width + 1) / 2, (in.size.height + 1) / 2};
  Planes out = Planes::zeros(size, in.channels, in.wraps);
  constexpr float kernel[4] = {0.125f, 0.375f, 0.375f, 0.125f};
  const int n = in.channels;
  const Task& task = CurrentTask::task();
  tbb::parallel_for(0, size.height, [&](int y) {
    task.check();
    // Vertically first, into one row; then horizontally.
    std::vector<float> row(size_t(in.size.width) * n, 0.0f);
    for (int j = 0; j < 4; j++) {
      const float* v = in.at(0, in.row(2 * y + j - 1));
      for (size_t i = 0; i < row.size(); i++) row[i] += kernel[j] * v[i];
    }
    for (int x = 0; x < size.width; x++) {
      float* o = out.at(x, y);
      for (int i = 0; i < 4; i++) {
        const float* v = row.data() + size_t(in.column(2 * x + i - 1)) * n;
        for (int c = 0; c < n; c++) o[c] += kernel[i] * v[c];
      }
    }
  });
  return out;
}

Planes shortened(const Planes& in, const Streaks& streaks) {
  if (!streaks.any()) return in;
  Planes out = Planes::zeros(streaks.shortened(in.size), in.channels, in.wraps);
  const float share = 1.0f / float(streaks.x * streaks.y);
  const int n = in.channels;
  tbb::parallel_for(0, out.size.height, [&](int y) {
    for (int x = 0; x < out.size.width; x++)
      for (int j = 0; j < streaks.y; j++)
        for (int i = 0; i < streaks.x; i++) {
          const float* v = in.at(x * streaks.x + i, y * streaks.y + j);
          for (int c = 0; c < n; c++) out.at(x, y)[c] += share * v[c];
        }
  });
  return out;
}

std::vector<float> leading_component(const Planes& planes, const Task& task) {
  const int n = planes.channels;
  const std::vector<float> axis = principal_components(planes.values, n, 1, task).components;
  const double sign = axis.front() < 0 ? -1 : 1;
  std::vector<float> out(size_t(planes.size.area()));
  tbb::parallel_for(0, planes.size.height, [&](int y) {
    for (int x = 0; x < planes.size.width; x++) {
      double sum = 0;
      for (int c = 0; c < n; c++) sum += double(axis[c]) * double(planes.at(x, y)[c]);
      out[size_t(y) * planes.size.width + x] = float(sign * sum);
    }
  });
  return out;
}

}  // namespace terrazzo
