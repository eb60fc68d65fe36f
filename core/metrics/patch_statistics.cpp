#include "core/metrics/patch_statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

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
  int descents = 3;
  int propagations = 4;
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
        {&PatchStatisticsTuning::descents, "descents", "pixels",
         "by which a patch that was found may move to a nearer one. Higher: what the pool lacks is found; costs time",
         "patch_similarity", 0},
        {&PatchStatisticsTuning::propagations, "propagations", "rounds",
         "in which patches that continue what others found are tried. Higher: the same; costs time", "patch_similarity",
         0},
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

/// Windows of an image, and a sample of them, projected.
struct Windows {
  const Planes& image;
  Size period;  ///< of windows that go on around its border; else 0
  const Projection& space;
  PatchList sample;
  std::vector<float> rows;  ///< of the sample
};

Windows sampled_windows(const Planes& image, Size period, const Projection& space, PatchList sample, const Task& task) {
  std::vector<float> rows = project(image, sample, space, task);
  return {image, period, space, std::move(sample), std::move(rows)};
}

double squared_distance(const float* a, const float* b, int count) {
  double sum = 0;
  for (int i = 0; i < count; i++) sum += double(a[i] - b[i]) * double(a[i] - b[i]);
  return sum;
}

/// Looks for the windows that are nearest to the first ones of a sample. If that is the windows' own, one that is less
/// than a step away does not count.
class WindowSearch {
  static constexpr size_t beside = 4;

 public:
  WindowSearch(const Windows& windows, const NearestPoints& tree, const Windows& queries, const Task& task)
      : windows_(windows),
        queries_(queries),
        task_(task),
        dimensions_(windows.space.outputs),
        places_(patch_positions(windows.image.size, windows.space.step)),
        from_(patch_positions(queries.image.size, windows.space.step)),
        found_(std::min(size_t(patch_statistics_tuning->queries), queries.sample.size())) {
    search(tree);
    if (windows.sample.size() == size_t(places_.area())) return;
    if (!is_own()) propagate();
    descend();
  }

  std::vector<double> distances() const {
    std::vector<double> out;
    for (const Found& f : found_) out.push_back(std::sqrt(f.squared));
    return out;
  }

 private:
  struct Place {
    int x = 0, y = 0;
  };
  struct Found {
    Place place;
    double squared = 0;
  };
  struct Offer {
    uint32_t query = 0;
    Place place;
  };

  bool is_own() const { return &queries_ == &windows_; }
  static Place place_of(uint32_t patch, Size places) {
    return {int(patch % uint32_t(places.width)), int(patch / uint32_t(places.width))};
  }
  Place place_of_query(size_t query) const { return place_of(queries_.sample[query], from_); }
  bool counts(size_t query, Place p) const {
    if (!is_own()) return true;
    const Place q = place_of_query(query);
    const auto apart = [](int a, int b, int period) {
      const int d = std::abs(a - b);
      return period > 0 ? std::min(d, period - d) : d;
    };
    return std::max(apart(p.x, q.x, windows_.period.width), apart(p.y, q.y, windows_.period.height)) >=
           windows_.space.step;
  }

  void search(const NearestPoints& tree) {
    tbb::parallel_for(tbb::blocked_range<size_t>(0, found_.size(), 64), [&](const auto& range) {
      task_.check();
      for (size_t i = range.begin(); i < range.end(); i++) {
        const auto left_out = [&](uint32_t k) { return !counts(i, place_of(windows_.sample[k], places_)); };
        const auto match = tree.find(&queries_.rows[i * dimensions_], patch_statistics_tuning->slack, left_out);
        found_[i] = {place_of(windows_.sample[match.index], places_), double(match.squared)};
      }
    });
  }

  /// Takes windows that are nearer than what was found. Returns the queries that took one.
  std::vector<uint32_t> take_nearer(std::vector<Offer> offers) {
    if (windows_.period.width > 0)
      for (Offer& o : offers) o.place = {wrap(o.place.x, places_.width), wrap(o.place.y, places_.height)};
    std::erase_if(offers, [&](const Offer& o) {
      return o.place.x < 0 || o.place.y < 0 || o.place.x >= places_.width || o.place.y >= places_.height ||
             !counts(o.query, o.place);
    });
    PatchList patches;
    for (const Offer& o : offers)
      patches.push_back(uint32_t(o.place.y) * uint32_t(places_.width) + uint32_t(o.place.x));
    const std::vector<float> rows = project(windows_.image, patches, windows_.space, task_);
    std::vector<uint32_t> moved;
    for (size_t k = 0; k < offers.size(); k++) {
      const uint32_t i = offers[k].query;
      const double squared =
          squared_distance(&rows[k * dimensions_], &queries_.rows[size_t(i) * dimensions_], dimensions_);
      if (squared >= found_[i].squared) continue;
      found_[i] = {offers[k].place, squared};
      if (moved.empty() || moved.back() != i) moved.push_back(i);
    }
    return moved;
  }

  /// Offers to every query what continues the windows that were found for the queries beside it.
  void propagate() {
    std::vector<std::array<uint32_t, beside>> neighbours(found_.size());
    tbb::parallel_for(size_t(0), found_.size(), [&](size_t i) { neighbours[i] = nearest_queries(i); });
    for (int round = 0; round < patch_statistics_tuning->propagations; round++) {
      std::vector<Offer> offers;
      for (uint32_t i = 0; i < found_.size(); i++)
        for (const uint32_t k : neighbours[i]) {
          const Place a = place_of_query(i), b = place_of_query(k), shown = found_[k].place;
          offers.push_back({i, {shown.x + a.x - b.x, shown.y + a.y - b.y}});
        }
      take_nearer(std::move(offers));
    }
  }

  std::array<uint32_t, beside> nearest_queries(size_t query) const {
    std::array<uint32_t, beside> nearest;
    std::array<int64_t, beside> squared;
    nearest.fill(uint32_t(query));
    squared.fill(std::numeric_limits<int64_t>::max());
    const Place q = place_of_query(query);
    for (size_t k = 0; k < found_.size(); k++) {
      const Place p = place_of_query(k);
      const int64_t d = int64_t{p.x - q.x} * (p.x - q.x) + int64_t{p.y - q.y} * (p.y - q.y);
      if (k == query || d >= squared.back()) continue;
      size_t at = beside - 1;
      for (; at > 0 && squared[at - 1] > d; at--) {
        squared[at] = squared[at - 1];
        nearest[at] = nearest[at - 1];
      }
      squared[at] = d;
      nearest[at] = uint32_t(k);
    }
    return nearest;
  }

  /// Moves what was found to windows beside it, as long as they are nearer.
  void descend() {
    std::vector<uint32_t> moving(found_.size());
    std::iota(moving.begin(), moving.end(), 0u);
    for (int round = 0; round < patch_statistics_tuning->descents && !moving.empty(); round++) {
      std::vector<Offer> offers;
      for (const uint32_t i : moving)
        for (int dy = -1; dy <= 1; dy++)
          for (int dx = -1; dx <= 1; dx++)
            if (dx != 0 || dy != 0) offers.push_back({i, {found_[i].place.x + dx, found_[i].place.y + dy}});
      moving = take_nearer(std::move(offers));
    }
  }

  const Windows& windows_;
  const Windows& queries_;
  const Task& task_;
  int dimensions_;
  Size places_;  ///< of windows
  Size from_;    ///< of queries
  std::vector<Found> found_;
};

}  // namespace

double sliced_wasserstein(const Planes& exemplar, const Planes& output, const Task& task) {
  if (exemplar.wraps) return sliced_wasserstein(with_windows_across(exemplar), output, task);
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

PatchSimilarity patch_similarity(const Planes& tile, const Planes& output, int step, const Task& task) {
  Planes across;
  if (tile.wraps) across = with_windows_across(tile, step);
  const Planes& exemplar = tile.wraps ? across : tile;
  const auto pool = size_t(patch_statistics_tuning->pool);
  const int dimensions = 8 * patch_statistics_tuning->eights_of_dimensions;
  PatchList from_exemplar = random_patches(exemplar.size, pool, exemplar_seed, step);
  PatchList from_output = random_patches(output.size, pool, output_seed(exemplar, output), step);
  const Projection space = principal_projection(exemplar, from_exemplar, dimensions, task, step);
  const Size period = tile.wraps ? tile.size : Size{};
  const Windows e = sampled_windows(exemplar, period, space, std::move(from_exemplar), task);
  const Windows o = sampled_windows(output, {}, space, std::move(from_output), task);
  std::array<std::unique_ptr<NearestPoints>, 2> trees;
  tbb::parallel_invoke([&] { trees[0] = std::make_unique<NearestPoints>(e.rows, dimensions); },
                       [&] { trees[1] = std::make_unique<NearestPoints>(o.rows, dimensions); });
  std::vector<double> among = WindowSearch(e, *trees[0], e, task).distances();
  const std::vector<double> coherent = WindowSearch(e, *trees[0], o, task).distances();
  const std::vector<double> complete = WindowSearch(o, *trees[1], e, task).distances();
  const double own = mean_of(among) + 1e-9;
  std::sort(among.begin(), among.end());
  const double usual = quantile(among, 0.95);
  const auto broken = std::count_if(coherent.begin(), coherent.end(), [&](double d) { return d > usual; });
  return {mean_of(coherent) / own, mean_of(complete) / own, double(broken) / double(coherent.size())};
}

}  // namespace terrazzo
