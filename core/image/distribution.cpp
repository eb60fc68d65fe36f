#include "core/image/distribution.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace terrazzo {

namespace {

constexpr int bins = 65536;
constexpr int strip_rows = 32;

struct Bin {
  uint64_t count = 0;
  ValueRange values;
};

/// Calls `visit(state of this thread, pixels, count)` for every strip. Takes the part [from, from + 0.5] of the
/// progress.
template <typename State, typename Visit>
void visit_strips(const Image& image, tbb::enumerable_thread_specific<State>& states, const Task& task, double from,
                  const Visit& visit) {
  const int strips = (image.height() + strip_rows - 1) / strip_rows;
  std::atomic<int> done{0};
  for_each_strip_at_once(image, strip_rows, task, [&](const Rect& region, const float* pixels) {
    task.progress(from + 0.5 * done++ / strips);
    visit(states.local(), pixels, region.area());
  });
}

std::vector<std::vector<Bin>> bins_of(const Image& image, const std::vector<ValueRange>& ranges, const Task& task) {
  const int channels = image.channels();
  std::vector<double> scale(channels, 0.0);
  for (int c = 0; c < channels; c++)
    if (ranges[c].max > ranges[c].min) scale[c] = (bins - 1) / (double(ranges[c].max) - ranges[c].min);
  using Bins = std::vector<std::vector<Bin>>;
  const Bins empty(channels, std::vector<Bin>(bins));
  tbb::enumerable_thread_specific<Bins> states(empty);
  visit_strips(image, states, task, 0.5, [&](Bins& all, const float* p, int64_t count) {
    for (int64_t i = 0; i < count; i++)
      for (int c = 0; c < channels; c++, p++) {
        if (!std::isfinite(*p)) continue;
        Bin& bin = all[c][int((double(*p) - ranges[c].min) * scale[c] + 0.5)];
        bin.count++;
        bin.values.include(*p);
      }
  });
  Bins sum = empty;
  for (const Bins& part : states)
    for (int c = 0; c < channels; c++)
      for (int b = 0; b < bins; b++) {
        sum[c][b].count += part[c][b].count;
        sum[c][b].values.include(part[c][b].values);
      }
  return sum;
}

double interpolated(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const size_t i = std::upper_bound(x.begin(), x.end(), at) - x.begin();
  if (i == 0) return y.front();
  if (i == x.size() || x[i - 1] == at) return y[i - 1];
  return y[i - 1] + (y[i] - y[i - 1]) * ((at - x[i - 1]) / (x[i] - x[i - 1]));
}

}  // namespace

void ValueRange::include(float v) {
  if (!std::isfinite(v)) return;
  min = std::min(min, v);
  max = std::max(max, v);
}

void ValueRange::include(const ValueRange& other) {
  min = std::min(min, other.min);
  max = std::max(max, other.max);
}

std::vector<ValueRange> value_ranges(const Image& image, const Task& task) {
  const int channels = image.channels();
  tbb::enumerable_thread_specific<std::vector<ValueRange>> states(
      [channels] { return std::vector<ValueRange>(channels); });
  visit_strips(image, states, task, 0, [channels](std::vector<ValueRange>& ranges, const float* p, int64_t count) {
    for (int64_t i = 0; i < count; i++)
      for (int c = 0; c < channels; c++) ranges[c].include(*p++);
  });
  std::vector<ValueRange> all(channels);
  for (const std::vector<ValueRange>& ranges : states)
    for (int c = 0; c < channels; c++) all[c].include(ranges[c]);
  return all;
}

Distribution::Distribution(std::vector<Atom> atoms) : atoms_(std::move(atoms)) {
  if (atoms_.empty()) atoms_.push_back({.value = 0, .count = 1});  // nothing was finite
  uint64_t total = 0, below = 0;
  for (const Atom& a : atoms_) total += a.count;
  for (const Atom& a : atoms_) {
    ranks_.push_back((double(below) + 0.5 * double(a.count)) / double(total));
    below += a.count;
  }
}

std::vector<Distribution> Distribution::of(const Image& image, const Task& task) {
  std::vector<Distribution> all;
  for (const std::vector<Bin>& channel : bins_of(image, value_ranges(image, task), task)) {
    std::vector<Atom> atoms;
    for (const Bin& b : channel) {
      // A bin of one value keeps that exactly; other bins use the middle of their values' range.
      const double middle = 0.5 * (double(b.values.min) + b.values.max);
      if (b.count) atoms.push_back({float(middle), b.count});
    }
    all.push_back(Distribution(std::move(atoms)));
  }
  return all;
}

Distribution Distribution::merged(const std::vector<Distribution>& parts) {
  std::vector<Atom> all, merged;
  for (const Distribution& p : parts) all.insert(all.end(), p.atoms_.begin(), p.atoms_.end());
  std::stable_sort(all.begin(), all.end(), [](const Atom& a, const Atom& b) { return a.value < b.value; });
  for (const Atom& a : all)
    if (!merged.empty() && merged.back().value == a.value)
      merged.back().count += a.count;
    else
      merged.push_back(a);
  return Distribution(std::move(merged));
}

double Distribution::mean() const {
  double sum = 0, total = 0;
  for (const Atom& a : atoms_) {
    sum += double(a.value) * double(a.count);
    total += double(a.count);
  }
  return sum / total;
}

double Distribution::deviation() const {
  const double middle = mean();
  double sum = 0, total = 0;
  for (const Atom& a : atoms_) {
    sum += (a.value - middle) * (a.value - middle) * double(a.count);
    total += double(a.count);
  }
  return std::sqrt(sum / total);
}

double Distribution::quantile(double rank) const {
  const size_t i = std::upper_bound(ranks_.begin(), ranks_.end(), rank) - ranks_.begin();
  if (i == 0) return min();
  if (i == ranks_.size()) return max();
  const double low = atoms_[i - 1].value, high = atoms_[i].value;
  return low + (high - low) * ((rank - ranks_[i - 1]) / (ranks_[i] - ranks_[i - 1]));
}

double Distribution::otsu_threshold() const {
  double total = 0, all = 0;
  for (const Atom& a : atoms_) {
    total += double(a.count);
    all += double(a.value) * double(a.count);
  }
  double low_count = 0, low_sum = 0, best = -1, threshold = min();
  for (size_t i = 0; i + 1 < atoms_.size(); i++) {
    low_count += double(atoms_[i].count);
    low_sum += double(atoms_[i].value) * double(atoms_[i].count);
    const double high_count = total - low_count;
    const double apart = low_sum / low_count - (all - low_sum) / high_count;
    const double between = low_count * high_count * apart * apart;
    if (between > best) {
      best = between;
      threshold = 0.5 * (double(atoms_[i].value) + atoms_[i + 1].value);
    }
  }
  return threshold;
}

double PiecewiseLinear::operator()(double x) const {
  return interpolated(x_, y_, x);
}

PiecewiseLinear matching_curve(const Distribution& from, const Distribution& to) {
  std::vector<double> x, y;
  for (size_t i = 0; i < from.atoms().size(); i++) {
    x.push_back(from.atoms()[i].value);
    y.push_back(to.quantile(from.ranks()[i]));
  }
  return {std::move(x), std::move(y)};
}

}  // namespace terrazzo
