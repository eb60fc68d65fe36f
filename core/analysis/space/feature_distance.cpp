#include "core/analysis/space/feature_distance.h"

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

Planes smoothed(Planes in, double deviation) {
  const std::vector<float> kernel = binomial_kernel(deviation);
  const int reach = int(kernel.size()) / 2, n = in.channels;
  if (reach == 0) return in;
  Planes across = in;
  const auto pass = [&](const Planes& from, Planes& to, bool horizontal) {
    tbb::parallel_for(0, in.size.height, [&](int y) {
      for (int x = 0; x < in.size.width; x++) {
        float* o = to.at(x, y);
        std::fill(o, o + n, 0.0f);
        for (int i = -reach; i <= reach; i++) {
          const float* v = horizontal ? from.at(from.column(x + i), y) : from.at(x, from.row(y + i));
          for (int c = 0; c < n; c++) o[c] += kernel[i + reach] * v[c];
        }
      }
    });
  };
  pass(in, across, true);
  pass(across, in, false);
  return in;
}

/// Scharr's operator on one channel.
Gradient gradient_at(const Planes& p, int x, int y, int channel) {
  const int up = p.row(y - 1), down = p.row(y + 1), left = p.column(x - 1), right = p.column(x + 1);
  const auto v = [&](int u, int w) { return p.at(u, w)[channel]; };
  return {3 * (v(right, up) - v(left, up)) + 10 * (v(right, y) - v(left, y)) + 3 * (v(right, down) - v(left, down)),
          3 * (v(left, down) - v(left, up)) + 10 * (v(x, down) - v(x, up)) + 3 * (v(right, down) - v(right, up))};
}

/// Gradient magnitude over all channels.
std::vector<float> gradient_magnitude(const Planes& p) {
  std::vector<float> out(size_t(p.size.area()));
  tbb::parallel_for(0, p.size.height, [&](int y) {
    for (int x = 0; x < p.size.width; x++) {
      float sum = 0;
      for (int c = 0; c < p.channels; c++) {
        const Gradient g = gradient_at(p, x, y, c);
        sum += g.x * g.x + g.y * g.y;
      }
      out[size_t(y) * p.size.width + x] = std::sqrt(sum) / 32;
    }
  });
  return out;
}

/// The gradient of what all channels together vary in most; x and y interleaved.
std::vector<float> leading_gradients(const Planes& p, const Task& task) {
  const Planes leading{p.size, 1, p.wraps, leading_component(p, task)};
  std::vector<float> out(2 * size_t(p.size.area()));
  tbb::parallel_for(0, p.size.height, [&](int y) {
    for (int x = 0; x < p.size.width; x++) {
      const Gradient g = gradient_at(leading, x, y, 0);
      const size_t at = 2 * (size_t(y) * p.size.width + x);
      out[at] = g.x / 32;
      out[at + 1] = g.y / 32;
    }
  });
  return out;
}

}  // namespace

Edges find_edges(const Material& material, const EdgeOptions& options, const Task& task) {
  const FeaturesPtr features =
      weighted_features(material, weights_of_chosen(material, options.maps), options.wraps, options.mask);
  const Planes planes = smoothed(weighted_planes(*features, task), options.smoothing);
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
