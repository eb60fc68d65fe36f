#include "core/analysis/bands.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace terrazzo {

namespace {

constexpr int most_repeats = 24;
constexpr double least_of_one = 0.25;  // certainty from which lines that come again only once count
constexpr double often = 5, often_counts = 0.5;
constexpr double multiple = 1.5;  // of a period found before, which a longer one must beat clearly
constexpr double clearly_better = 1.15;
constexpr double better = 0.005;

/// How whole lines correlate with one another.
class LineCorrelation {
 public:
  LineCorrelation(const Correlation& r, bool courses)
      : values_(size_t((courses ? r.lags().height : r.lags().width) - 3), 0.0) {
    const int along = courses ? r.lags().width : r.lags().height;
    const int length = courses ? r.exemplar().width : r.exemplar().height;
    for (int d = 0; d < int(values_.size()); d++) {
      double pairs = 0;
      for (int t = r.wraps() ? 0 : 1 - along; t < along; t++) {
        const double weight = r.wraps() ? 1 : length - std::abs(t);
        values_[size_t(d)] += weight * (courses ? r.at(t, d) : r.at(d, t));
        pairs += weight;
      }
      values_[size_t(d)] /= pairs;
    }
  }

  int size() const { return int(values_.size()); }
  double at(double d) const {
    const auto i = size_t(d);
    return values_[i] + (d - double(i)) * (values_[std::min(values_.size() - 1, i + 1)] - values_[i]);
  }

  /// How far lines a period apart are more alike than lines half a period apart; nearly all must be.
  double certainty(double period) const {
    double sum = 0, squares = 0;
    int count = 0;
    for (double d = period; d < size() - 1 && count < most_repeats; d += period, count++) {
      const double v = at(d) - at(d - period / 2);
      sum += v;
      squares += v * v;
    }
    if (count == 0) return -1;
    const double mean = sum / count, deviation = std::sqrt(std::max(0.0, squares / count - mean * mean));
    const double low = mean - (0.3 + 1.4 / count) * deviation;
    return count > 1 || low >= least_of_one ? low : -1;
  }

  /// Of what lines a period apart have in common; what nearly all exceed.
  double alike(double period) const {
    double sum = 0, squares = 0;
    int count = 0;
    for (double d = period; d < size() - 1 && count < most_repeats; d += period, count++) {
      const double v = std::max({at(d - 1), at(d), at(std::min(size() - 1.0, d + 1))}) / std::max(1e-12, at(0));
      sum += v;
      squares += v * v;
    }
    const double mean = sum / std::max(1, count);
    return std::clamp(mean - std::sqrt(std::max(0.0, squares / std::max(1, count) - mean * mean)), 0.0, 1.0);
  }

 private:
  std::vector<double> values_;
};

}  // namespace

Bands bands_of(const Correlation& r, bool courses) {
  const LineCorrelation lines(r, courses);
  double best = 0, certainty = 0;
  const auto consider = [&](double period) {
    const double needed = best > 0 && period > multiple * best ? clearly_better * certainty : certainty;
    if (const double c = lines.certainty(period); c > needed + better) {
      best = period;
      certainty = c;
    }
  };
  if (r.wraps()) {
    const int length = courses ? r.exemplar().height : r.exemplar().width;
    for (int n = int(length / shortest_repeat); n >= 2; n--) consider(double(length) / n);
  } else {
    for (double period = shortest_repeat; period <= lines.size() / 1.3; period += 0.1) consider(period);
    for (int step = -20; step <= 20 && best > 0; step++)
      if (const double c = lines.certainty(best + 0.005 * step); c > certainty) {
        certainty = c;
        best += 0.005 * step;
        step = -20;
      }
  }
  if (best == 0) return {};
  const double distinct = certainty / std::sqrt(std::max(certainty, lines.at(0)));
  // Thin joints are little of all there is, but what comes again so often is no chance.
  if (lines.size() >= (r.wraps() ? 2 : 1) * often * best) certainty = std::max(certainty, often_counts * distinct);
  return {
      {1, courses ? Vector2{0, best} : Vector2{best, 0}, {}, std::min(1.0, certainty)}, distinct, lines.alike(best)};
}

}  // namespace terrazzo
