#include "core/analysis/space/feature_distance.h"

#include <array>
#include <cmath>

#include <tbb/parallel_for.h>

#include "core/analysis/space/mask_pyramid.h"
#include "core/analysis/space/planes.h"
#include "core/analysis/space/weighting.h"
#include "core/base/tuning.h"
#include "core/image/distribution.h"
#include "core/numeric/distance_transform.h"

namespace terrazzo {

namespace {

struct FeatureDistanceTuning {
  int specks = 200;
};
const Tunable<FeatureDistanceTuning> feature_distance_tuning(
    "feature_distance", {
                            {&FeatureDistanceTuning::specks, "specks", "parts of the pixels",
                             "of which one may have stronger edges than what counts as the strongest. Higher: "
                             "single specks set the scale; lower: faint edges count as strong ones",
                             "not measured: single specks must not set the scale", 2},
                        });

struct Gradient {
  float x, y;
};

/// A Gaussian kernel made of repeated binomials. It stays beside blurred(), whose kernel is sampled, as that gave no
/// better results (experiments.md#guidance).
std::vector<float> binomial_kernel(double deviation) {
  // n steps of (1 2 1) / 4 have variance n / 2.
  const int steps = int(std::floor(2 * deviation * deviation + 0.5));
  std::vector<double> k = {1};
  for (int s = 0; s < steps; s++) {
    std::vector<double> next(k.size() + 2, 0.0);
    for (size_t i = 0; i < k.size(); i++) {
      next[i] += k[i] / 4;
      next[i + 1] += k[i] / 2;
      next[i + 2] += k[i] / 4;
    }
    k = std::move(next);
  }
  return {k.begin(), k.end()};
}

Planes smoothed(Planes in, double deviation, const Task& task) {
  const std::vector<float> kernel = binomial_kernel(deviation);
  if (kernel.size() == 1) return in;
  in = filtered_across(in, kernel, Beyond::as_it_wraps, task);
  return filtered_down(in, kernel, Beyond::as_it_wraps, task);
}

/// The gradient at every value of a row, by Scharr's operator.
std::vector<Gradient> row_gradients(const Planes& p, int y) {
  const auto n = size_t(p.channels), row_values = size_t(p.size.width) * n;
  // Rows with a pixel more at either end, so that all of them can be worked on side by side.
  std::array<std::vector<float>, 3> rows;
  for (int j = 0; j < 3; j++) {
    rows[size_t(j)].resize(row_values + 2 * n);
    for (int x = -1; x <= p.size.width; x++)
      std::copy_n(p.at(p.column(x), p.row(y + j - 1)), n, &rows[size_t(j)][size_t(x + 1) * n]);
  }
  const float *up = rows[0].data() + n, *at = rows[1].data() + n, *down = rows[2].data() + n;
  const float *left_up = up - n, *left = at - n, *left_down = down - n;
  std::vector<Gradient> out(row_values);
  for (size_t i = 0; i < row_values; i++)
    out[i] = {3 * (up[i + n] - left_up[i]) + 10 * (at[i + n] - left[i]) + 3 * (down[i + n] - left_down[i]),
              3 * (left_down[i] - left_up[i]) + 10 * (down[i] - up[i]) + 3 * (down[i + n] - up[i + n])};
  return out;
}

/// Gradient magnitude over all channels.
std::vector<float> gradient_magnitude(const Planes& p) {
  std::vector<float> out(size_t(p.size.area()));
  tbb::parallel_for(0, p.size.height, [&](int y) {
    const std::vector<Gradient> row = row_gradients(p, y);
    const Gradient* g = row.data();
    for (int x = 0; x < p.size.width; x++) {
      float sum = 0;
      for (int c = 0; c < p.channels; c++, g++) sum += g->x * g->x + g->y * g->y;
      out[size_t(y) * size_t(p.size.width) + size_t(x)] = std::sqrt(sum) / 32;
    }
  });
  return out;
}

/// The gradient of what all channels together vary in most; x and y interleaved.
std::vector<float> leading_gradients(const Planes& p, const Task& task) {
  const Planes leading{p.size, 1, p.wraps, leading_component(p, task)};
  std::vector<float> out(2 * size_t(p.size.area()));
  tbb::parallel_for(0, p.size.height, [&](int y) {
    float* to = &out[2 * size_t(y) * size_t(p.size.width)];
    for (const Gradient& g : row_gradients(leading, y)) {
      *to++ = g.x / 32;
      *to++ = g.y / 32;
    }
  });
  return out;
}

}  // namespace

Edges find_edges(const Material& material, const EdgeOptions& options, const Task& task) {
  const FeaturesPtr features =
      weighted_features(material, weights_of_chosen(material, options.maps), options.wraps, options.mask);
  Planes weighted = unmasked_planes(*features, task);  // not shared: they are smoothed in place
  fill_masked(weighted, *features);
  const Planes planes = smoothed(std::move(weighted), options.smoothing, task);
  Edges edges;
  edges.strength = gradient_magnitude(planes);
  edges.gradients = leading_gradients(planes, task);
  const std::vector<uint8_t> allowed = allowed_pixels(*features);
  for (size_t i = 0; i < allowed.size(); i++)
    if (!allowed[i]) edges.strength[i] = 0;
  // Relative to nearly the strongest.
  std::vector<float> sorted = edges.strength;
  const size_t strong = sorted.size() - 1 - sorted.size() / size_t(feature_distance_tuning->specks);
  std::nth_element(sorted.begin(), sorted.begin() + ptrdiff_t(strong), sorted.end());
  const float unit = std::max(sorted[strong], 1e-6f);
  for (float& v : edges.strength) v = std::min(1.0f, v / unit);
  if (options.threshold) {
    edges.threshold = *options.threshold;
  } else {
    const ImageInfo info{.size = planes.size, .channels = 1, .semantic = Semantic::data};
    edges.threshold = Distribution::of(*Image::from_floats(info, edges.strength), task).front().otsu_threshold();
  }
  for (const float v : edges.strength) edges.mask.push_back(v >= float(edges.threshold));
  return edges;
}

ImagePtr feature_distance(const Edges& edges, Size size, bool wraps, float limit) {
  ImageInfo info{.size = size, .channels = 1, .semantic = Semantic::guidance};
  return Image::from_floats(info, signed_distances(edges.mask, size, wraps, limit));
}

}  // namespace terrazzo
