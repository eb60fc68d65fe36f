#include "core/stochastic/histogram_transform.h"

#include <algorithm>
#include <cmath>

#include "core/numeric/gaussian.h"

namespace terrazzo {

namespace {

constexpr double farthest = 5;            ///< deviations; a Gaussian number in 1.7 million lies beyond
constexpr int gaussian_intervals = 4096;  ///< 0.0024 deviations each
constexpr double smoothed = 1.0 / 1024;   ///< of a sample, whose ranks are not sure to a pixel

/// The first and the last of an atom's pixels, as ranks, with the atom's value.
template <typename Visit>
void for_each_end(const Distribution& d, const Visit& visit) {
  double total = 0, below = 0;
  for (const Distribution::Atom& a : d.atoms()) total += double(a.count);
  for (const Distribution::Atom& a : d.atoms()) {
    visit((below + 0.5) / total, double(a.value));
    if (a.count > 1) visit((below + double(a.count) - 0.5) / total, double(a.value));
    below += double(a.count);
  }
}

/// Values to the Gaussian number of their rank, scaled to a variance of 1.
PiecewiseLinear to_gaussian_curve(const Distribution& d) {
  std::vector<double> x, y;
  double sum = 0, squares = 0, total = 0;
  for (size_t i = 0; i < d.atoms().size(); i++) {
    const auto count = double(d.atoms()[i].count);
    x.push_back(d.atoms()[i].value);
    y.push_back(normal_quantile(d.ranks()[i]));
    sum += count * y.back();
    squares += count * y.back() * y.back();
    total += count;
  }
  const double mean = sum / total, deviation = std::sqrt(std::max(0.0, squares / total - mean * mean));
  for (double& g : y) g = deviation > 0 ? (g - mean) / deviation : 0;
  return {std::move(x), std::move(y)};
}

LookupTable from_gaussian_table(const Distribution& d) {
  std::vector<double> x, y;
  for_each_end(d, [&](double rank, double value) {
    x.push_back(normal_quantile(rank));
    y.push_back(value);
  });
  return {-farthest, farthest, gaussian_intervals, PiecewiseLinear(std::move(x), std::move(y))};
}

}  // namespace

PiecewiseLinear sorted_pixels(const Distribution& distribution) {
  std::vector<double> x, y;
  for_each_end(distribution, [&](double rank, double value) {
    x.push_back(rank);
    y.push_back(value);
  });
  return {std::move(x), std::move(y)};
}

LookupTable::LookupTable(double low, double high, int intervals, const std::function<double(double)>& function)
    : low_(low), scale_(high > low ? intervals / (high - low) : 0) {
  for (int i = 0; i <= intervals; i++) values_.push_back(float(function(low + (high - low) * i / intervals)));
}

double LookupTable::operator()(double x) const {
  const double at = std::clamp((x - low_) * scale_, 0.0, double(values_.size() - 1));
  const size_t i = std::min(size_t(at), values_.size() - 2);
  return portable::mix(values_[i], values_[i + 1], at - double(i));
}

HistogramTransform::HistogramTransform(const Distribution& values)
    : forward_(to_gaussian_curve(values)), back_(from_gaussian_table(values)) {}

PiecewiseLinear restoring_curve(const Distribution& from, const Distribution& to) {
  const PiecewiseLinear wanted = sorted_pixels(to);
  double total = 0, below = 0, count = 0, sum = 0;
  for (const Distribution::Atom& a : from.atoms()) total += double(a.count);
  std::vector<double> x, y;
  const auto point = [&](double value, double rank) {
    if (!x.empty() && x.back() >= value) return;
    x.push_back(value);
    y.push_back(wanted(rank));
  };
  const auto end_group = [&] {
    if (count > 0) point(sum / count, (below + 0.5 * count) / total);
    below += count;
    count = sum = 0;
  };
  point(from.min(), double(from.atoms().front().count) / total < smoothed ? 0 : from.ranks().front());
  for (const Distribution::Atom& a : from.atoms()) {
    if (double(a.count) >= smoothed * total) end_group();
    count += double(a.count);
    sum += double(a.value) * double(a.count);
    if (count >= smoothed * total) end_group();
  }
  end_group();
  if (double(from.atoms().back().count) < smoothed * total) point(from.max(), 1);
  return {std::move(x), std::move(y)};
}

}  // namespace terrazzo
