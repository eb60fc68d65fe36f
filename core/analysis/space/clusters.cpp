#include "core/analysis/space/clusters.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <tbb/parallel_for.h>

#include "core/base/hash.h"
#include "core/base/tuning.h"

namespace terrazzo {

namespace {

constexpr int64_t chunk = 4096;  // what one thread sums by itself; chunks are then added in order

struct ClustersTuning {
  int most_samples = 262144;
  int seed_candidates = 4;
};
const Tunable<ClustersTuning> clusters_tuning(
    "clusters", {
                    {&ClustersTuning::most_samples, "most_samples", "pixels",
                     "of which centres are learnt. Higher: small clusters are found; costs time",
                     "not measured: taken over from the code before constants were listed", 1},
                    {&ClustersTuning::seed_candidates, "seed_candidates", "pixels",
                     "that are tried for each seed. Higher: better seeds; costs time",
                     "not measured: taken over from the code before constants were listed", 1},
                });

int64_t chunks_of(int64_t count) {
  return (count + chunk - 1) / chunk;
}

template <typename Visit>
void for_each_chunk(int64_t count, const Visit& visit) {
  tbb::parallel_for(int64_t{0}, chunks_of(count),
                    [&](int64_t i) { visit(i, i * chunk, std::min(count, (i + 1) * chunk)); });
}

/// The sum of value(i), the same for any number of threads.
template <typename Value>
double ordered_sum(int64_t count, const Value& value) {
  std::vector<double> parts(size_t(chunks_of(count)), 0.0);
  for_each_chunk(count, [&](int64_t part, int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; i++) parts[size_t(part)] += value(i);
  });
  return std::accumulate(parts.begin(), parts.end(), 0.0);
}

template <typename Center>
double squared_distance(const float* point, const Center* centre, int channels) {
  double sum = 0;
  for (int c = 0; c < channels; c++) {
    const double d = double(point[c]) - double(centre[c]);
    sum += d * d;
  }
  return sum;
}

struct Nearest {
  int centre = 0;
  double squared = 0;
};

Nearest nearest_centre(const float* point, const std::vector<double>& centres, int channels) {
  Nearest best{0, squared_distance(point, centres.data(), channels)};
  for (size_t k = 1; k * channels < centres.size(); k++) {
    const double d = squared_distance(point, &centres[k * channels], channels);
    if (d < best.squared) best = {int(k), d};
  }
  return best;
}

/// A part of the pixels, one out of each stretch of equal length.
std::vector<float> samples_of(const Planes& planes, uint64_t seed) {
  const int64_t pixels = planes.size.area(), most_samples = clusters_tuning->most_samples;
  if (pixels <= most_samples) return planes.values;
  const int n = planes.channels;
  std::vector<float> out(size_t(most_samples) * n);
  for (int64_t i = 0; i < most_samples; i++) {
    const int64_t begin = i * pixels / most_samples, end = (i + 1) * pixels / most_samples;
    const int64_t at = begin + below(uint32_t(random_bits(seed, 0, i)), uint32_t(end - begin));
    std::copy_n(&planes.values[size_t(at) * n], n, &out[size_t(i) * n]);
  }
  return out;
}

/// The learning of centres from samples.
class Learner {
 public:
  Learner(std::vector<float> samples, int channels)
      : samples_(std::move(samples)), channels_(channels), count_(int64_t(samples_.size()) / channels) {}

  /// k-means++: each further seed is drawn with a probability that goes with its squared distance to those before.
  std::vector<double> seeds(const ClusterOptions& options, const Task& task) const {
    std::vector<double> centres;
    append(centres, int64_t(below(uint32_t(random_bits(options.seed, 1)), uint32_t(count_))));
    std::vector<double> nearest(size_t(count_), INFINITY);
    update(nearest, centres.data());
    for (int k = 1; k < options.count; k++) {
      task.check();
      const double total = ordered_sum(count_, [&](int64_t i) { return nearest[size_t(i)]; });
      if (!(total > 0)) break;  // every sample is a seed's equal
      int64_t best = 0;
      double least = INFINITY;
      for (int t = 0; t < clusters_tuning->seed_candidates; t++) {
        const int64_t candidate = drawn(nearest, unit_double(random_bits(options.seed, 2, k, t)) * total);
        const float* point = sample(candidate);
        const double left = ordered_sum(count_, [&](int64_t i) {
          return std::min(nearest[size_t(i)], squared_distance(sample(i), point, channels_));
        });
        if (left < least) {
          least = left;
          best = candidate;
        }
      }
      append(centres, best);
      update(nearest, &centres[centres.size() - size_t(channels_)]);
    }
    return centres;
  }

  /// Moves every centre to the mean of the samples nearest to it; false if none changed sides.
  bool step(std::vector<double>& centres, std::vector<int>& labels) const {
    const size_t k = centres.size() / size_t(channels_), row = k * size_t(channels_ + 1);
    const int64_t parts = chunks_of(count_);
    std::vector<double> sums(size_t(parts) * row, 0.0);  // per chunk and centre: number, then summed channels
    std::vector<uint8_t> moved(size_t(parts), 0);
    std::vector<double> squared(static_cast<size_t>(count_));
    for_each_chunk(count_, [&](int64_t part, int64_t begin, int64_t end) {
      for (int64_t i = begin; i < end; i++) {
        const Nearest n = nearest_centre(sample(i), centres, channels_);
        if (n.centre != labels[size_t(i)]) moved[size_t(part)] = 1;
        labels[size_t(i)] = n.centre;
        squared[size_t(i)] = n.squared;
        double* sum = &sums[size_t(part) * row + size_t(n.centre) * size_t(channels_ + 1)];
        sum[0] += 1;
        for (int c = 0; c < channels_; c++) sum[c + 1] += double(sample(i)[c]);
      }
    });
    for (int64_t part = 1; part < parts; part++)
      for (size_t i = 0; i < row; i++) sums[i] += sums[size_t(part) * row + i];
    for (size_t j = 0; j < k; j++) {
      const double* sum = &sums[j * size_t(channels_ + 1)];
      double* centre = &centres[j * size_t(channels_)];
      if (sum[0] > 0)
        for (int c = 0; c < channels_; c++) centre[c] = sum[c + 1] / sum[0];
      else
        take_farthest(squared, centre);
    }
    return std::find(moved.begin(), moved.end(), 1) != moved.end();
  }

  int64_t count() const { return count_; }

 private:
  const float* sample(int64_t i) const { return &samples_[size_t(i) * size_t(channels_)]; }

  void append(std::vector<double>& centres, int64_t i) const {
    centres.insert(centres.end(), sample(i), sample(i) + channels_);
  }

  void update(std::vector<double>& nearest, const double* centre) const {
    for_each_chunk(count_, [&](int64_t, int64_t begin, int64_t end) {
      for (int64_t i = begin; i < end; i++)
        nearest[size_t(i)] = std::min(nearest[size_t(i)], squared_distance(sample(i), centre, channels_));
    });
  }

  /// The first sample at which the running sum of weights exceeds `target`.
  int64_t drawn(const std::vector<double>& weights, double target) const {
    double sum = 0;
    int64_t last = 0;
    for (int64_t i = 0; i < count_; i++) {
      if (!(weights[size_t(i)] > 0)) continue;
      last = i;
      sum += weights[size_t(i)];
      if (sum > target) break;
    }
    return last;
  }

  /// A centre that has lost all its samples starts anew where the others fit worst.
  void take_farthest(std::vector<double>& squared, double* centre) const {
    const auto at = std::max_element(squared.begin(), squared.end());
    *at = 0;
    const float* point = sample(at - squared.begin());
    std::copy_n(point, channels_, centre);
  }

  std::vector<float> samples_;
  int channels_;
  int64_t count_;
};

void sort_rows(std::vector<double>& centres, int channels) {
  std::vector<std::vector<double>> rows;
  for (size_t i = 0; i < centres.size(); i += size_t(channels))
    rows.emplace_back(centres.begin() + ptrdiff_t(i), centres.begin() + ptrdiff_t(i) + channels);
  std::sort(rows.begin(), rows.end());
  auto out = centres.begin();
  for (const std::vector<double>& r : rows) out = std::copy(r.begin(), r.end(), out);
}

}  // namespace

Clusters find_clusters(const Planes& planes, const ClusterOptions& options, const Task& task) {
  const Learner learner(samples_of(planes, options.seed), planes.channels);
  std::vector<double> centres = learner.seeds(options, task);
  std::vector<int> labels(size_t(learner.count()), -1);
  for (int i = 0; i < options.iterations; i++) {
    task.progress(double(i) / options.iterations);
    if (!learner.step(centres, labels)) break;
  }
  sort_rows(centres, planes.channels);
  Clusters out{int(centres.size()) / planes.channels, planes.channels, centres,
               std::vector<uint8_t>(size_t(planes.size.area())), std::vector<float>(size_t(planes.size.area()))};
  for_each_chunk(planes.size.area(), [&](int64_t, int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; i++) {
      const Nearest n = nearest_centre(&planes.values[size_t(i) * size_t(planes.channels)], centres, planes.channels);
      out.labels[size_t(i)] = uint8_t(n.centre);
      out.distances[size_t(i)] = float(std::sqrt(n.squared));
    }
  });
  return out;
}

}  // namespace terrazzo
