#include "core/metrics/patch_statistics.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include "core/base/tuning.h"
#include "core/metrics/patches.h"
#include "core/numeric/nearest.h"

namespace terrazzo {

namespace {

constexpr uint64_t exemplar_seed = 7, direction_seed = 9;

/// Images of one size are sampled at the same places, so that an image compared with itself has distance 0.
uint64_t output_seed(const Planes& exemplar, const Planes& output) {
  return output.size == exemplar.size ? exemplar_seed : 8;
}

struct PatchStatisticsTuning {
  double slack = 0.1;
  int eights_of_directions = 20;
  int quantiles = 512;
  int sliced_patches = 20000;
  int pool = 120000;
  int queries = 4000;
  int eights_of_dimensions = 3;
};
const Tunable<PatchStatisticsTuning> patch_statistics_tuning(
    "patch_statistics",
    {
        {&PatchStatisticsTuning::slack, "slack", "share of a distance",
         "by which the nearest patch may be missed. Higher: less time; lower: coherence and completeness are exact",
         "not measured: bounds the time"},
        {&PatchStatisticsTuning::eights_of_directions, "eights_of_directions", "eight directions",
         "in which patches are compared for swd. Higher: it varies less; costs time",
         "not measured: taken over from the code before constants were listed", 1, 125},
        {&PatchStatisticsTuning::quantiles, "quantiles", "values in each direction",
         "the same. Higher: tails have a say; costs time",
         "not measured: taken over from the code before constants were listed", 2},
        {&PatchStatisticsTuning::sliced_patches, "sliced_patches", "patches",
         "the same. Higher: it varies less; costs time",
         "not measured: taken over from the code before constants were listed", 1},
        {&PatchStatisticsTuning::pool, "pool", "patches",
         "among which the nearest is looked for. Higher: rare features are found; costs time",
         "not measured: taken over from the code before constants were listed", 2},
        {&PatchStatisticsTuning::queries, "queries", "patches",
         "for which it is. Higher: figures vary less; costs time",
         "not measured: taken over from the code before constants were listed", 1},
        {&PatchStatisticsTuning::eights_of_dimensions, "eights_of_dimensions", "eight components",
         "of a patch in which it is. Higher: fine detail has a say; costs time",
         "not measured: taken over from the code before constants were listed", 1, 6},
    });

/// The quantile of sorted numbers, with linear interpolation; `t` in [0, 1].
template <typename T>
double quantile(const std::vector<T>& sorted, double t) {
  const double at = t * double(sorted.size() - 1);
  const size_t i = std::min(size_t(at), sorted.size() - 1), j = std::min(i + 1, sorted.size() - 1);
  return sorted[i] + (at - double(i)) * (double(sorted[j]) - sorted[i]);
}

std::vector<float> sorted_column(const std::vector<float>& rows, int width, int column) {
  std::vector<float> out(rows.size() / width);
  for (size_t i = 0; i < out.size(); i++) out[i] = rows[i * width + column];
  std::sort(out.begin(), out.end());
  return out;
}

double deviation(const std::vector<float>& values) {
  Moments<1> m;
  for (const float v : values) m.add(double(v));
  return std::sqrt(m.variance());
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / double(values.size());
}

/// The distances of the first rows of `points` to their nearest neighbours in `tree`.
std::vector<double> nearest_distances(const NearestPoints& tree, const std::vector<float>& points,
                                      bool among_themselves, const Task& task) {
  const int dimensions = 8 * patch_statistics_tuning->eights_of_dimensions;
  const double slack = patch_statistics_tuning->slack;
  std::vector<double> out(std::min(size_t(patch_statistics_tuning->queries), points.size() / size_t(dimensions)));
  tbb::parallel_for(tbb::blocked_range<size_t>(0, out.size(), 64), [&](const auto& range) {
    task.check();
    for (size_t i = range.begin(); i < range.end(); i++) {
      const auto itself = [&](uint32_t other) { return among_themselves && other == i; };
      out[i] = std::sqrt(double(tree.find(&points[i * dimensions], slack, itself).squared));
    }
  });
  return out;
}

}  // namespace

double sliced_wasserstein(const Planes& exemplar, const Planes& output, const Task& task) {
  const int directions = 8 * patch_statistics_tuning->eights_of_directions,
            quantiles = patch_statistics_tuning->quantiles;
  const auto sliced_patches = size_t(patch_statistics_tuning->sliced_patches);
  const Projection slices = random_directions(patch_values(exemplar), directions, direction_seed);
  const auto a = project(exemplar, random_patches(exemplar.size, sliced_patches, exemplar_seed), slices, task);
  const auto b =
      project(output, random_patches(output.size, sliced_patches, output_seed(exemplar, output)), slices, task);
  std::vector<double> distance(directions);
  tbb::parallel_for(0, directions, [&](int k) {
    task.check();
    const std::vector<float> p = sorted_column(a, directions, k), q = sorted_column(b, directions, k);
    double sum = 0;
    for (int i = 0; i < quantiles; i++) {
      const double t = double(i) / (quantiles - 1);
      sum += std::abs(quantile(p, t) - quantile(q, t));
    }
    distance[k] = sum / quantiles / (deviation(p) + 1e-6);
  });
  return mean_of(distance);
}

PatchSimilarity patch_similarity(const Planes& exemplar, const Planes& output, const Task& task) {
  const auto pool = size_t(patch_statistics_tuning->pool);
  const int dimensions = 8 * patch_statistics_tuning->eights_of_dimensions;
  const PatchList from_exemplar = random_patches(exemplar.size, pool, exemplar_seed);
  const PatchList from_output = random_patches(output.size, pool, output_seed(exemplar, output));
  const Projection space = principal_projection(exemplar, from_exemplar, dimensions, task);
  const std::vector<float> e = project(exemplar, from_exemplar, space, task);
  const std::vector<float> o = project(output, from_output, space, task);
  std::array<std::unique_ptr<NearestPoints>, 2> trees;
  tbb::parallel_invoke([&] { trees[0] = std::make_unique<NearestPoints>(e, dimensions); },
                       [&] { trees[1] = std::make_unique<NearestPoints>(o, dimensions); });
  std::vector<double> among = nearest_distances(*trees[0], e, true, task);
  const std::vector<double> coherent = nearest_distances(*trees[0], o, false, task);
  const std::vector<double> complete = nearest_distances(*trees[1], e, false, task);
  const double own = mean_of(among) + 1e-9;
  std::sort(among.begin(), among.end());
  const double usual = quantile(among, 0.95);
  const auto broken = std::count_if(coherent.begin(), coherent.end(), [&](double d) { return d > usual; });
  return {mean_of(coherent) / own, mean_of(complete) / own, double(broken) / double(coherent.size())};
}

}  // namespace terrazzo
