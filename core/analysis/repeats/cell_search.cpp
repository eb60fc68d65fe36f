#include "core/analysis/repeats/cell_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/analysis/repeats/near_peaks.h"
#include "core/base/tuning.h"
#include "core/numeric/moments.h"

namespace terrazzo {

namespace {

struct CellTuning {
  double longest = 6;
  double same_point = 2;
  double good_enough = 0.4;
  double same_area = 1.02;
  double least_gap = 0.1;
  double least_errors = 4;
  double least_errors_of_parts = 6;
  double least_deviation = 0.03;
  double few_points = 1.3;
  double least_alike_of_drawn = 0.93;
  double near_whole = 0.15;
  double on_point = 0.15;
  int farthest = 5;
};
const Tunable<CellTuning> cell_tuning(
    "cell_search",
    {
        {&CellTuning::longest, "longest", "shorter sides",
         "what the longer side of a cell may have, around an exemplar that tiles. Higher: bands are taken for cells; "
         "lower: long boards are not found",
         "What each rule decides", 1},
        {&CellTuning::same_point, "same_point", "pixels",
         "within which points are the same around an exemplar that tiles. Higher: imprecise lattices count none twice; "
         "lower: fine cells have more points",
         "What each rule decides"},
        {&CellTuning::good_enough, "good_enough", "share of the best score",
         "what a lattice must reach. Higher: the most distinct one wins; lower: denser ones that are less distinct win",
         "What each rule decides", 0, 1},
        {&CellTuning::same_area, "same_area", "factor",
         "up to which cells are of one size. Higher: larger ones that are more alike win; lower: the smallest wins",
         "What each rule decides"},
        {&CellTuning::least_gap, "least_gap", "share of the correlation",
         "by which it must be lower on points that are others. Higher: denser lattices win; lower: cells that differ a "
         "little are kept apart",
         "What each rule decides"},
        {&CellTuning::least_errors, "least_errors", "standard errors",
         "the same. Higher: denser lattices win; lower: chance decides",
         "not measured: hundreds of lattices are compared with one another"},
        {&CellTuning::least_errors_of_parts, "least_errors_of_parts", "standard errors",
         "the same where multiples of one lattice are compared with it. Higher: chequered tiles become one; lower: "
         "alike ones are kept apart",
         "What each rule decides"},
        {&CellTuning::least_deviation, "least_deviation", "share of the correlation",
         "of points, for that comparison. Higher: few points say less; lower: those that happen to agree decide",
         "not measured: deviations of few points say little", 0.000001},
        {&CellTuning::few_points, "few_points", "points",
         "whose share a lattice loses of its score. Higher: few points say less; lower: large cells are found",
         "not measured: few points may stand out by chance"},
        {&CellTuning::least_alike_of_drawn, "least_alike_of_drawn", "correlation",
         "higher: fewer drawn patterns are rounded to whole pixels; lower: photographs are, too", "regularity", 0, 1},
        {&CellTuning::near_whole, "near_whole", "pixels",
         "what a step may be off whole ones to be rounded. Higher: drawn patterns come out exact; lower: photographs "
         "keep their steps",
         "regularity", 0, 0.5},
        {&CellTuning::on_point, "on_point", "steps",
         "within which a point is another lattice's, too. Higher: imprecise lattices share points; lower: those near "
         "by tell them apart",
         "What each rule decides"},
        {&CellTuning::farthest, "farthest", "steps from the origin",
         "at which a lattice is judged. Higher: chance lattices fail; lower: those that are a little off do not",
         "What each rule decides", 1, 100},
    });

constexpr double least_slant = 0.4;  // sine of the angle between two peaks: the shortest vectors have at least 0.86
constexpr int most_multiple = 4;     // of multiples that are compared with a lattice
constexpr int most_around = 12;      // cells of an exemplar that tiles: of so few, all lattices are tried

/// The shortest vectors that span the same lattice (Lagrange and Gauss).
void reduce(Vector2d& a, Vector2d& b) {
  if (a.squaredNorm() > b.squaredNorm()) std::swap(a, b);
  for (int step = 0; step < 50; step++) {
    const double n = std::floor(a.dot(b) / a.squaredNorm() + 0.5);
    if (n == 0) return;
    b -= n * a;
    if (b.squaredNorm() >= a.squaredNorm()) return;
    std::swap(a, b);
  }
}

/// A lattice's points within the lags, the origin left out: of two opposite ones, and of those that are the same around
/// an exemplar that tiles, one.
std::vector<Vector2d> points_of(const Correlation& r, Vector2d a, Vector2d b) {
  std::vector<Vector2d> points;
  const double same_point = cell_tuning->same_point;
  const int farthest = cell_tuning->farthest;
  const double w = r.exemplar().width, h = r.exemplar().height;
  const auto same = [&](Vector2d p, Vector2d q) {
    const double x = std::abs(p.x() - q.x()), y = std::abs(p.y() - q.y());
    return std::min(x, std::abs(w - x)) <= same_point && std::min(y, std::abs(h - y)) <= same_point;
  };
  for (int j = 0; j <= farthest; j++)
    for (int i = j == 0 ? 1 : -farthest; i <= farthest; i++) {
      Vector2d d = i * a + j * b;
      if (r.wraps()) {
        d -= Vector2d{w * std::floor(d.x() / w + 0.5), h * std::floor(d.y() / h + 0.5)};
        if (same(d, {0, 0})) continue;
        if (std::any_of(points.begin(), points.end(), [&](Vector2d p) { return same(p, d) || same(-p, d); })) continue;
      }
      if (r.covers(d.x(), d.y())) points.push_back(d);
    }
  return points;
}

struct Point {
  Vector2d at;
  double value;
};

/// What the correlation is at some lags.
Moments<1> moments(const std::vector<Point>& points) {
  Moments<1> m;
  for (const Point& p : points) m.add(p.value);
  return m;
}

/// Of what these were drawn from.
double deviation(const Moments<1>& m) {
  return m.count() > 1 ? std::sqrt(m.variance() * double(m.count()) / double(m.count() - 1)) : 0;
}

/// The correlation around the points, in the direction in which it is highest: along courses it remains high.
double around_points(const Correlation& r, const std::vector<Point>& points, double distance) {
  constexpr std::array<std::array<int, 2>, 12> directions{
      {{1, 0}, {4, 1}, {2, 1}, {1, 1}, {1, 2}, {1, 4}, {0, 1}, {-1, 4}, {-1, 2}, {-1, 1}, {-2, 1}, {-4, 1}}};
  double most = 0;
  for (const auto& [x, y] : directions) {
    const double unit = distance / std::sqrt(double(x * x + y * y));
    double total = 0;
    int count = 0;
    for (const Point& p : points)
      for (const double part : {-0.55, -0.35, 0.35, 0.55}) {
        const Vector2d at = p.at + part * unit * Vector2d(x, y);
        if (!r.covers(at.x(), at.y())) continue;
        total += r.at(at);
        count++;
      }
    if (count >= 4) most = std::max(most, total / count);
  }
  return most;
}

struct Candidate {
  Vector2d a, b;
  std::vector<Point> points;
  Moments<1> on;
  double around = 0;
  double score = -1;

  double area() const { return std::abs(cross(a, b)); }
  /// Whether a point is one of the lattice's, to a part of a cell.
  bool has(Vector2d p, double within) const {
    const double d = cross(a, b), i = cross(p, b) / d, j = cross(a, p) / d;
    return std::abs(i - std::floor(i + 0.5)) < within && std::abs(j - std::floor(j + 0.5)) < within;
  }
};

/// How far a lattice's points stand out; nearly all must, and few points may do so by chance.
Candidate judged(const Correlation& r, Vector2d a, Vector2d b, double hopeless) {
  Candidate c{a, b, {}, {}, 0, -1};
  int off_a = 0, off_b = 0;
  for (const Vector2d& d : points_of(r, a, b)) {
    c.points.push_back({d, r.peak_near(d).second});
    off_a += std::abs(cross(a, d)) > 0.5 * c.area();
    off_b += std::abs(cross(b, d)) > 0.5 * c.area();
  }
  // A line and a chance point make no lattice, but a line around an exemplar that tiles comes again beside itself.
  if (r.wraps() ? c.points.size() < 2 : c.points.size() < 3 || off_a < 2 || off_b < 2) return c;
  c.on = moments(c.points);
  const auto count = double(c.on.count());
  const double few = 1 - cell_tuning->few_points / count;
  const double low = c.on.mean() - deviation(c.on) * (1 + 1 / std::sqrt(count));
  if (low * few <= hopeless) return c;
  c.around = around_points(r, c.points, a.norm());
  c.score = (low - c.around) * few;
  return c;
}

/// Whether the correlation on one lattice's points, those left out that are the other's too, is lower than on the
/// other's by more than chance (Student's test).
bool is_worse(const Candidate& c, const Candidate& than, double errors) {
  if (c.on.mean() >= than.on.mean()) return false;
  std::vector<Point> own;
  for (const Point& p : c.points)
    if (!than.has(p.at, cell_tuning->on_point)) own.push_back(p);
  if (own.size() < 2) return false;
  const Moments<1> on = moments(own), &other = than.on;
  if (on.mean() >= other.mean() * (1 - cell_tuning->least_gap)) return false;
  const auto a = double(on.count()), b = double(other.count());
  const double least = cell_tuning->least_deviation * other.mean();
  const double variance = std::max(least * least, (a * on.variance() + b * other.variance()) / (a + b - 2));
  return other.mean() - on.mean() > errors * std::sqrt(variance * (1 / a + 1 / b));
}

/// Fits both vectors to all peaks near the lattice's points, out to so many steps.
void refine(const Correlation& r, Vector2d& a, Vector2d& b, int steps) {
  for (int reach = 2; reach <= steps; reach *= 2) {
    double ii = 0, ij = 0, jj = 0;
    Vector2d pi, pj;
    for (int i = -reach; i <= reach; i++)
      for (int j = -reach; j <= reach; j++) {
        const Vector2d d = i * a + j * b;
        if ((i == 0 && j == 0) || !r.covers(d.x(), d.y())) continue;
        const auto [p, value] = r.peak_near(d);
        const double w = std::max(0.0, value);
        ii += w * i * i;
        ij += w * i * j;
        jj += w * j * j;
        pi += w * i * p;
        pj += w * j * p;
      }
    const double determinant = ii * jj - ij * ij;
    if (determinant <= 1e-9 * ii * jj) return;
    a = jj / determinant * pi - ij / determinant * pj;
    b = ii / determinant * pj - ij / determinant * pi;
  }
}

double on_points(const Correlation& r, const Lattice& l) {
  double sum = 0;
  int count = 0;
  for (const Vector2d& d : points_of(r, l.first, l.second)) {
    sum += r.at(d);
    count++;
  }
  return sum / std::max(1, count);
}

/// Drawn patterns repeat by whole pixels, to which no fit to their peaks comes quite.
Lattice rounded_if_drawn(const Correlation& r, const Lattice& l) {
  Lattice whole = l;
  for (Vector2d* v : {&whole.first, &whole.second}) {
    const Vector2d rounded = (v->array() + 0.5).floor();
    if ((rounded - *v).lpNorm<Eigen::Infinity>() > cell_tuning->near_whole) return l;
    *v = rounded;
  }
  return whole.is_valid() && on_points(r, whole) >= cell_tuning->least_alike_of_drawn ? whole : l;
}

class CellSearch {
 public:
  explicit CellSearch(const Correlation& r) : r_(r) {}

  void add(Vector2d a, Vector2d b) {
    if (std::abs(cross(a, b)) < least_slant * std::sqrt(a.squaredNorm() * b.squaredNorm())) return;
    reduce(a, b);
    if (!fit(a, b)) return;
    const double area = std::abs(cross(a, b));
    if (std::any_of(candidates_.begin(), candidates_.end(), [&](const Candidate& c) {
          return std::abs(c.area() - area) < 0.1 * area && c.has(a, 0.02) && c.has(b, 0.02);
        }))
      return;
    Candidate c = judged(r_, a, b, cell_tuning->good_enough * highest_);
    if (c.score <= 0) return;
    highest_ = std::max(highest_, c.score);
    candidates_.push_back(std::move(c));
  }

  /// The densest that does not do worse than any other; null if there is none.
  const Candidate* best() {
    const double least = cell_tuning->good_enough * highest_;
    candidates_.erase(
        std::remove_if(candidates_.begin(), candidates_.end(), [&](const Candidate& c) { return c.score < least; }),
        candidates_.end());
    std::stable_sort(candidates_.begin(), candidates_.end(),
                     [](const Candidate& a, const Candidate& b) { return a.area() < b.area(); });
    const Candidate* best = nullptr;
    for (const Candidate& c : candidates_) {
      if (best && c.area() > cell_tuning->same_area * best->area()) break;
      if ((!best || c.on.mean() > best->on.mean()) &&
          std::none_of(candidates_.begin(), candidates_.end(),
                       [&](const Candidate& other) { return is_worse(c, other, errors_against(other)); }))
        best = &c;
    }
    return best;
  }

 private:
  /// Of many lattices of few points some have high ones by chance; around an exemplar that tiles not many fit.
  double errors_against(const Candidate& c) const {
    return r_.wraps() ? cell_tuning->least_errors : cell_tuning->least_errors * (1 + 1.0 / double(c.on.count()));
  }

  /// Fits both vectors to peaks near them. An exemplar that tiles holds whole steps; false if it is far from that.
  bool fit(Vector2d& a, Vector2d& b) const {
    if (!r_.wraps()) {
      refine(r_, a, b, 2);
      return true;
    }
    if (b.squaredNorm() > cell_tuning->longest * cell_tuning->longest * a.squaredNorm()) return false;
    const Lattice whole = Lattice{2, a, b, 0}.fitted(r_.exemplar(), true, true);
    const auto close = [](const Vector2d& p, const Vector2d& q) { return (p - q).lpNorm<Eigen::Infinity>() < 1; };
    if (!close(whole.first, a) || !close(whole.second, b)) return false;
    a = whole.first;
    b = whole.second;
    reduce(a, b);
    return true;
  }

  const Correlation& r_;
  std::vector<Candidate> candidates_;
  double highest_ = 0;
};

}  // namespace

Cell best_cell(const Correlation& r, const std::vector<Lattice>& further) {
  CellSearch search(r);
  const std::vector<Vector2d> peaks = near_peaks(r);
  for (size_t p = 0; p < peaks.size(); p++)
    for (size_t q = p + 1; q < peaks.size(); q++) search.add(peaks[p], peaks[q]);
  for (const Lattice& l : further) search.add(l.first, l.second);
  // Of few cells few peaks are seen; all the lattices can be tried.
  for (int cells = 2; r.wraps() && cells <= most_around; cells++)
    for (const Lattice& l : lattices_around(r.exemplar(), cells)) search.add(l.first, l.second);
  const Candidate* best = search.best();
  if (!best) return {};
  Lattice out{2, best->a, best->b, std::clamp(best->on.mean() - deviation(best->on), 0.0, 1.0)};
  refine(r, out.first, out.second, 24);
  out = rounded_if_drawn(r, out);
  if (std::abs(out.first.x()) < std::abs(out.second.x())) std::swap(out.first, out.second);
  if (out.first.x() < 0) out.first = -out.first;
  if (out.second.y() < 0) out.second = -out.second;
  return {out, best->score / std::max(0.01, 1 - best->around)};
}

Lattice without_false_repeats(const Correlation& r, const Lattice& lattice, double least_gap) {
  if (lattice.rank != 2) return lattice;
  Vector2d a = lattice.first, b = lattice.second;
  reduce(a, b);
  const Candidate all = judged(r, a, b, -2);
  Lattice best = lattice;
  double largest = least_gap;
  for (int cells = 2; cells <= most_multiple; cells++)
    for (int p = 1; p <= cells; p++) {
      if (cells % p != 0) continue;
      // Every sublattice of that many cells has a basis p * a, q * a + rows * b (Hermite normal form).
      for (int q = 0; q < p; q++) {
        const Candidate c = judged(r, p * a, q * a + cells / p * b, -2);
        if (c.on.count() < 3 || c.on.mean() <= 0 || !is_worse(all, c, cell_tuning->least_errors_of_parts)) continue;
        // Of the correlation on the sublattice's points, what the others lack.
        const double gap = (1 - all.on.mean() / c.on.mean()) * cells / (cells - 1);
        if (gap <= largest) continue;
        largest = gap;
        best.first = c.a;
        best.second = c.b;
      }
    }
  return best;
}

}  // namespace terrazzo
