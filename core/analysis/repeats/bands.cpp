#include "core/analysis/repeats/bands.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/analysis/repeats/straight_lines.h"
#include "core/base/tuning.h"
#include "core/numeric/moments.h"

namespace terrazzo {

namespace {

struct BandsTuning {
  double least_of_one = 0.25;
  double expected_deviation = 0.5;
  double expected_counts = 2;
  double deviations = 0.3;
  double deviations_of_few = 1.4;
  double often = 5;
  double often_counts = 0.55;
  double multiple = 1.5;
  double clearly_better = 1.15;
  double better = 0.005;
  double near_best = 0.03;
  double least_turned = 0.3;
  double seen = 1.3;
  double fine_step = 0.005;
  int most_repeats = 24;
};
const Tunable<BandsTuning> bands_tuning(
    "bands",
    {
        {&BandsTuning::least_of_one, "least_of_one", "correlation",
         "by how much lines that come again only once must be more alike. Higher: longer periods need more proof; "
         "lower: an exemplar may show two periods only, and chance ones are taken",
         "What each rule decides"},
        {&BandsTuning::expected_deviation, "expected_deviation", "share of the mean",
         "how much repeats are expected to vary. Higher: few repeats count for less; lower: longer periods of few "
         "repeats win",
         "not measured: only with and without were compared"},
        {&BandsTuning::expected_counts, "expected_counts", "repeats",
         "for how many repeats expected_deviation counts. Higher: few repeats count for less; lower: those that happen "
         "to agree win, with wrong, longer periods",
         "regularity"},
        {&BandsTuning::deviations, "deviations", "deviations",
         "what nearly all of many repeats exceed. Higher: uneven courses are less certain; lower: chance is taken for "
         "courses",
         "What each rule decides"},
        {&BandsTuning::deviations_of_few, "deviations_of_few", "deviations times repeats",
         "the same, in addition, divided by their number. Higher: few repeats are less certain; lower: chance is taken "
         "for courses",
         "What each rule decides"},
        {&BandsTuning::often, "often", "periods",
         "how many there must be for certainty to rise by what lines have in common. Higher: fewer exemplars profit; "
         "lower: chance does",
         "regularity"},
        {&BandsTuning::often_counts, "often_counts", "factor",
         "what such certainty is of that of all lines. Higher: thin joints are surer; lower: they are too little of "
         "all there is",
         "What each rule decides"},
        {&BandsTuning::multiple, "multiple", "periods found before",
         "from which on a longer one must be clearly better. Higher: multiples win more easily; lower: small "
         "corrections must be clear, too",
         "not measured: half-way to the next multiple"},
        {&BandsTuning::clearly_better, "clearly_better", "factor",
         "by which a multiple must be better. Higher: courses of several kinds are taken for one; lower: multiples of "
         "the true period win",
         "What each rule decides"},
        {&BandsTuning::better, "better", "correlation",
         "by which any period must be better. Higher: the shortest of alike periods wins; lower: their noise decides",
         "What each rule decides"},
        {&BandsTuning::near_best, "near_best", "share of a period",
         "within which the most certain one is looked for. Higher: coarse steps do no harm; costs time. Lower: less "
         "time",
         "What each rule decides", 0, 0.5},
        {&BandsTuning::least_turned, "least_turned", "correlation",
         "of orientations, by which every second band must differ from its neighbours. Higher: mirrored columns are "
         "taken for one another; lower: chance doubles periods",
         "regularity"},
        {&BandsTuning::seen, "seen", "periods",
         "how many of the longest one the exemplar must show. Higher: long periods are surer; lower: longer ones are "
         "looked for",
         "What each rule decides", 1},
        {&BandsTuning::fine_step, "fine_step", "pixels",
         "the same near the best one. Higher: less time; lower: a period is known more exactly",
         "What each rule decides", 0.0001},
        {&BandsTuning::most_repeats, "most_repeats", "repeats",
         "higher: more repeats are averaged; costs time. Lower: those far off, where a period that is not quite right "
         "has drifted, have no say",
         "What each rule decides"},
    });

// Periods and slants are looked for more finely near the best one.
constexpr double period_step = 0.1;  // pixels
constexpr int slants = 192;          // from level to diagonal

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
    const double expected = bands_tuning->expected_deviation * mean, chance = 1 - alike * alike;
    const double counts = bands_tuning->expected_counts;
    return exceeded((count * variance + counts * chance * expected * expected) / (count + counts));
  }

 private:
  double exceeded(double of_variance) const {
    if (count == 0 || (count == 1 && mean < bands_tuning->least_of_one)) return -1;
    return mean - (bands_tuning->deviations + bands_tuning->deviations_of_few / count) * std::sqrt(of_variance);
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
    for (double d = period; d < size() - 1 && exceed.count() < bands_tuning->most_repeats; d += period) {
      exceed.add(at(d) - at(d - period / 2));
      alike.add(at(d) / std::max(1e-12, at(0)));
    }
    return {int(exceed.count()), exceed.mean(), exceed.variance(), std::clamp(alike.mean(), 0.0, 1.0)};
  }

  /// Of what lines a period apart have in common; what nearly all exceed.
  double alike(double period) const {
    Moments<1> alike;
    for (double d = period; d < size() - 1 && alike.count() < bands_tuning->most_repeats; d += period)
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
    const double needed =
        best > 0 && period > bands_tuning->multiple * best ? bands_tuning->clearly_better * evidence : evidence;
    if (const double e = lines.repeats(period).evidence(); e > needed + bands_tuning->better) {
      best = period;
      evidence = e;
    }
  };
  if (r.wraps()) {
    const int length = courses ? r.exemplar().height : r.exemplar().width;
    for (int n = int(length / shortest_repeat()); n >= 2; n--) consider(double(length) / n);
  } else {
    for (double period = shortest_repeat(); period <= lines.size() / bands_tuning->seen; period += period_step)
      consider(period);
    LineRepeats most = best > 0 ? lines.repeats(best) : LineRepeats{};
    const double last = best * (1 + bands_tuning->near_best);
    for (double period = best * (1 - bands_tuning->near_best); period < last; period += bands_tuning->fine_step)
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
  if (lines.size() >= (r.wraps() ? 2 : 1) * bands_tuning->often * best)
    certainty = std::max(certainty, bands_tuning->often_counts * distinct(certainty));
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
      if (step == 0) continue;
      const double rise = double(step) / slants;
      if (const double differ = line_correlation(r, courses, rise, 0); differ > best.differ)
        best = {courses, rise, differ};
    }
  for (double by = 0.5 / slants; by > 1e-5; by /= 2)
    for (const double rise : {best.rise - by, best.rise + by})
      if (const double differ = line_correlation(r, best.courses, rise, 0); differ > best.differ)
        best = {best.courses, rise, differ};
  return best;
}

/// Along the stripes it is as far as across them.
Lattice lattice_of_stripes(const Slant& slant, double period, double certainty) {
  const double step = period / (1 + slant.rise * slant.rise);
  if (slant.courses) return {2, {step, slant.rise * step}, {0, period}, certainty};
  return {2, {period, 0}, {slant.rise * step, step}, certainty};
}

}  // namespace

Bands bands_of(const Correlation& r, bool courses) {
  return bands_that_rise(r, courses, 0);
}

bool come_often(const Lattice& bands, Size exemplar) {
  return count_bands(bands, exemplar) >= bands_tuning->often;
}

double count_bands(const Lattice& bands, Size exemplar) {
  return (bands.first.x() == 0 ? exemplar.height : exemplar.width) / bands.first.sum();
}

Lattice with_turned_bands(const Correlation& r, const Lattice& bands) {
  const LineCorrelation lines(r, bands.first.y() != 0, 0);
  const double twice = 2 * bands.first.sum();
  Lattice out = bands;
  if (lines.repeats(twice).certainty() >= bands_tuning->least_turned) out.first *= 2;
  return out;
}

Bands stripes_of(const Correlation& r) {
  const Slant slant = slant_of_stripes(r);
  if (slant.differ <= 0) return {};
  Bands out = bands_that_rise(r, slant.courses, slant.rise);
  if (out.lattice.rank > 0)
    out.lattice = lattice_of_stripes(slant, out.lattice.first.maxCoeff(), out.lattice.certainty);
  return out.lattice.rank > 0 ? out : Bands{};
}

Bands single_stripes_of(const Correlation& r, const Correlation& joints) {
  const Slant slant = slant_of_stripes(r);
  if (!r.wraps() || line_correlation(joints, slant.courses, slant.rise, 0) < least_of_lines()) return {};
  const int period = slant.courses ? r.exemplar().height : r.exemplar().width;
  // Half a period apart lines are as unlike as can be. Of grain they have nothing to do with one another.
  const double opposed = std::clamp(-line_correlation(r, slant.courses, slant.rise, period / 2), 0.0, 1.0);
  return {lattice_of_stripes(slant, period, opposed), opposed, opposed};
}

}  // namespace terrazzo
