#include "core/analysis/repeats/bands.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/numeric/moments.h"

namespace terrazzo {

namespace {

constexpr int most_repeats = 24;
constexpr double least_of_one = 0.25;  // by how much lines that come again only once must be more alike
// How much repeats are expected to vary, of their mean, and for how many repeats that counts.
constexpr double expected_deviation = 0.5, expected_counts = 2;
constexpr double often = 5, often_counts = 0.55;
constexpr double multiple = 1.5;  // of a period found before, which a longer one must beat clearly
constexpr double clearly_better = 1.15;
constexpr double better = 0.005;
constexpr int slants = 192;          // that are tried from level to diagonal
constexpr double least_rise = 0.04;  // of lines that are not level
constexpr double near_best = 0.03;   // of a period, within which the most certain one is looked for

/// How far lines that repeat stand out.
struct LineRepeats {
  int count = 0;
  double mean = 0, variance = 0;
  double alike = 0;  ///< their correlation with what they repeat

  /// What nearly all exceed.
  double certainty() const { return exceeded(variance); }
  /// The same for choosing among periods: few repeats that happen to agree say less than many that nearly do. The more
  /// alike they are, the less it is chance.
  double evidence() const {
    const double expected = expected_deviation * mean, chance = 1 - alike * alike;
    return exceeded((count * variance + expected_counts * chance * expected * expected) / (count + expected_counts));
  }

 private:
  double exceeded(double of_variance) const {
    if (count == 0 || (count == 1 && mean < least_of_one)) return -1;
    return mean - (0.3 + 1.4 / count) * std::sqrt(of_variance);
  }
};

/// How whole lines correlate that lie `apart` and rise by so much from pixel to pixel.
double line_correlation(const Correlation& r, bool courses, double rise, int apart) {
  const int length = courses ? r.exemplar().width : r.exemplar().height;
  const int breadth = courses ? r.exemplar().height : r.exemplar().width;
  const int lags = courses ? r.lags().width : r.lags().height, most = (courses ? r.lags().height : r.lags().width) - 1;
  const auto at = [&](int along, int across) { return courses ? r.at(along, across) : r.at(across, along); };
  double sum = 0, pairs = 0;
  const int begin = r.wraps() ? -(length / 2) : 1 - lags, end = r.wraps() ? length - length / 2 : lags;
  for (int t = begin; t < end; t++) {
    double across = apart + rise * t;
    if (r.wraps()) across -= breadth * std::floor(across / breadth + 0.5);
    const int low = int(std::floor(across));
    if (std::abs(across) >= most) continue;
    const double part = across - low, weight = r.wraps() ? 1 : (length - std::abs(t)) * (breadth - std::abs(across));
    sum += weight * (part > 0 ? (1 - part) * at(t, low) + part * at(t, low + 1) : at(t, low));
    pairs += weight;
  }
  return pairs > 0 ? sum / pairs : 0;
}

/// The same of lines any distance apart.
class LineCorrelation {
 public:
  LineCorrelation(const Correlation& r, bool courses, double rise)
      : values_(size_t((courses ? r.lags().height : r.lags().width) - 3)) {
    for (int d = 0; d < int(values_.size()); d++) values_[size_t(d)] = line_correlation(r, courses, rise, d);
  }

  int size() const { return int(values_.size()); }
  double at(double d) const {
    const auto i = size_t(d);
    return values_[i] + (d - double(i)) * (values_[std::min(values_.size() - 1, i + 1)] - values_[i]);
  }

  /// How far lines a period apart are more alike than lines half a period apart.
  LineRepeats repeats(double period) const {
    Moments<1> exceed, alike;
    for (double d = period; d < size() - 1 && exceed.count() < most_repeats; d += period) {
      exceed.add(at(d) - at(d - period / 2));
      alike.add(at(d) / std::max(1e-12, at(0)));
    }
    return {int(exceed.count()), exceed.mean(), exceed.variance(), std::clamp(alike.mean(), 0.0, 1.0)};
  }

  /// Of what lines a period apart have in common; what nearly all exceed.
  double alike(double period) const {
    Moments<1> alike;
    for (double d = period; d < size() - 1 && alike.count() < most_repeats; d += period)
      alike.add(std::max({at(d - 1), at(d), at(std::min(size() - 1.0, d + 1))}) / std::max(1e-12, at(0)));
    return std::clamp(alike.mean() - std::sqrt(alike.variance()), 0.0, 1.0);
  }

 private:
  std::vector<double> values_;
};

/// Of the period after which lines that rise so are most surely alike.
Bands bands_that_rise(const Correlation& r, bool courses, double rise) {
  const LineCorrelation lines(r, courses, rise);
  double best = 0, evidence = 0;
  const auto consider = [&](double period) {
    const double needed = best > 0 && period > multiple * best ? clearly_better * evidence : evidence;
    if (const double e = lines.repeats(period).evidence(); e > needed + better) {
      best = period;
      evidence = e;
    }
  };
  if (r.wraps()) {
    const int length = courses ? r.exemplar().height : r.exemplar().width;
    for (int n = int(length / shortest_repeat); n >= 2; n--) consider(double(length) / n);
  } else {
    for (double period = shortest_repeat; period <= lines.size() / 1.3; period += 0.1) consider(period);
    LineRepeats most = best > 0 ? lines.repeats(best) : LineRepeats{};
    const double last = best * (1 + near_best);
    for (double period = best * (1 - near_best); period < last; period += 0.005)
      if (const LineRepeats n = lines.repeats(period); n.count == most.count && n.certainty() > most.certainty()) {
        most = n;
        best = period;
      }
  }
  if (best == 0) return {};
  const auto distinct = [&](double v) { return v / std::sqrt(std::max(v, lines.at(0))); };
  const LineRepeats found = lines.repeats(best);
  double certainty = found.certainty();
  // Thin joints are little of all there is, but what comes again so often is no chance.
  if (lines.size() >= (r.wraps() ? 2 : 1) * often * best)
    certainty = std::max(certainty, often_counts * distinct(certainty));
  return {{1, courses ? Vector2d{0, best} : Vector2d{best, 0}, {}, std::min(1.0, certainty)},
          distinct(found.evidence()),
          lines.alike(best)};
}

/// Which way lines run.
struct Slant {
  bool courses = true;
  double rise = 0;
  double differ = 0;  ///< from one another, of all there is
};

/// That of lines which differ most: along stripes.
Slant slant_of_stripes(const Correlation& r) {
  Slant best;
  for (const bool courses : {true, false})
    for (int step = -slants; step <= slants; step++) {
      const double rise = double(step) / slants;
      if (std::abs(rise) < least_rise) continue;
      if (const double differ = line_correlation(r, courses, rise, 0); differ > best.differ)
        best = {courses, rise, differ};
    }
  for (double by = 0.5 / slants; by > 1e-5; by /= 2)
    for (const double rise : {best.rise - by, best.rise + by})
      if (const double differ = line_correlation(r, best.courses, rise, 0); differ > best.differ)
        best = {best.courses, rise, differ};
  return best;
}

}  // namespace

Bands bands_of(const Correlation& r, bool courses) {
  return bands_that_rise(r, courses, 0);
}

Bands stripes_of(const Correlation& r) {
  const Slant slant = slant_of_stripes(r);
  if (slant.differ <= 0) return {};
  Bands out = bands_that_rise(r, slant.courses, slant.rise);
  if (out.lattice.rank == 0) return {};
  const Vector2d across = out.lattice.first;
  const double period = across.maxCoeff();
  const double step = period / (1 + slant.rise * slant.rise);  // along the stripes it is as far as across them
  const Vector2d along = slant.courses ? Vector2d{step, slant.rise * step} : Vector2d{slant.rise * step, step};
  out.lattice = {2, slant.courses ? along : across, slant.courses ? across : along, out.lattice.certainty};
  return out;
}

}  // namespace terrazzo
