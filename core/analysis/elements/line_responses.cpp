#include "core/analysis/elements/line_responses.h"

#include <cmath>

#include <tbb/parallel_for.h>

#include "core/base/tuning.h"
#include "core/numeric/principal_components.h"

namespace terrazzo {

namespace {

struct LineResponsesTuning {
  double centre = 1.0;
  double surround = 3.5;
};
const Tunable<LineResponsesTuning> line_responses_tuning(
    "line_responses", {
                          {&LineResponsesTuning::centre, "centre", "pixels",
                           "deviation of the Gaussian over the line. Higher: noise and fine cracks count for "
                           "less; lower: narrow joints are told",
                           "elements", 0.3, 8},
                          {&LineResponsesTuning::surround, "surround", "pixels",
                           "deviation of the Gaussian over what lies around it. Higher: wide joints are lines "
                           "too; lower: shading across a stone is none",
                           "elements", 0.5, 32},
                      });

/// The strength of edges at a pixel, over all channels.
float edge_strength(const Planes& p, int x, int y) {
  const float *left = p.at(p.column(x - 1), y), *right = p.at(p.column(x + 1), y);
  const float *above = p.at(x, p.row(y - 1)), *below = p.at(x, p.row(y + 1));
  double sum = 0;
  for (int c = 0; c < p.channels; c++) {
    const double across = double(right[c]) - double(left[c]), down = double(below[c]) - double(above[c]);
    sum += across * across + down * down;
  }
  return float(std::sqrt(sum));
}

}  // namespace

Planes line_responses(const Planes& image, const Task& task) {
  const Planes centre = box_blurred(image, line_responses_tuning->centre, task);
  const Planes surround = box_blurred(image, line_responses_tuning->surround, task);
  const int n = image.channels;
  Planes out = Planes::zeros(image.size, n + 1, image.wraps);
  tbb::parallel_for(0, image.size.height, [&](int y) {
    for (int x = 0; x < image.size.width; x++) {
      float* o = out.at(x, y);
      for (int c = 0; c < n; c++) o[c] = centre.at(x, y)[c] - surround.at(x, y)[c];
      o[n] = edge_strength(centre, x, y);
    }
  });
  return out;
}

Planes leading_planes(const Planes& image, int most, const Task& task) {
  const int n = image.channels, kept = std::min(most, n);
  const std::vector<float> axes = principal_components(image.values, n, kept, task).components;
  const Moments<> moments = channel_moments(image);
  double variance = 0;
  for (int c = 0; c < n; c++) variance += moments.variance(c);
  const double unit = 1 / std::sqrt(std::max(variance, 1e-12));
  Planes out = Planes::zeros(image.size, kept, image.wraps);
  tbb::parallel_for(0, image.size.height, [&](int y) {
    for (int x = 0; x < image.size.width; x++)
      for (int k = 0; k < kept; k++) {
        double sum = 0;
        for (int c = 0; c < n; c++)
          sum += double(axes[size_t(k) * size_t(n) + size_t(c)]) * (double(image.at(x, y)[c]) - moments.mean(c));
        out.at(x, y)[k] = float(sum * unit);
      }
  });
  return out;
}

}  // namespace terrazzo
