#include "core/analysis/repeats/cell_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/numeric/moments.h"

namespace terrazzo {

namespace {

constexpr double least_peak = 0.02;
constexpr size_t most_peaks = 44;
constexpr size_t strongest = 5;      // peaks that may be chance
constexpr double strong = 0.5;       // of the next
constexpr double least_slant = 0.4;  // sine of the angle between two vectors
constexpr double longest = 6;        // of a cell's sides against the other, around an exemplar that tiles
constexpr int farthest = 5;          // steps from the origin at which a lattice is judged
constexpr double same_point = 2;     // pixels
constexpr double good_enough = 0.4;  // of the best score
constexpr double same_area = 1.02;
// By what part of it correlation on points must be lower before they count as others, and by how many standard errors:
// hundreds of lattices are compared with one another.
constexpr double least_gap = 0.1, least_errors = 4;
// The same where one lattice has been found and its multiples are compared with it.
constexpr int most_cells = 4;
constexpr double least_errors_of_parts = 6;
// Cells of photographs are hardly ever as alike, and then seldom lie so near whole pixels.
constexpr double least_alike_of_drawn = 0.93, no_difference = 0.01, near_whole = 0.15;
constexpr int fewest_around = 4, most_around = 12;  // cells of an exemplar that tiles, of which all lattices are tried

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

/// The nearest of the strong peaks: a lattice's shortest vectors are among them, however many points it has.
std::vector<Vector2d> near_peaks(const Correlation& r) {
  struct Peak {
    Vector2d at;
    double value;
  };
  std::vector<Peak> peaks;
  for (int y = 0; y < r.lags().height - 3; y++)
    for (int x = y == 0 ? 1 : 4 - r.lags().width; x < r.lags().width - 3; x++) {
      if (x * x + y * y < shortest_repeat * shortest_repeat || !r.covers(x, y)) continue;
      const double v = r.at(x, y);
      bool highest = v > least_peak;
      for (int j = -2; j <= 2 && highest; j++)
        for (int i = -2; i <= 2 && highest; i++) highest = r.at(x + i, y + j) <= v;
      if (!highest) continue;
      const auto [at, value] = r.peak_near({double(x), double(y)});
      peaks.push_back({at, value});
    }
  if (peaks.empty()) return {};
  const size_t rank = std::min(strongest, peaks.size() - 1);
  std::nth_element(peaks.begin(), peaks.begin() + ptrdiff_t(rank), peaks.end(),
                   [](const Peak& a, const Peak& b) { return a.value > b.value; });
  const double least = strong * peaks[rank].value;
  std::vector<Vector2d> out;
  for (const Peak& p : peaks)
    if (p.value >= least) out.push_back(p.at);
  const auto nearness = [](const Vector2d& v) { return std::tuple(v.squaredNorm(), v.y(), v.x()); };
  std::ranges::sort(out, {}, nearness);
  if (out.size() > most_peaks) out.resize(most_peaks);
  return out;
}

/// A lattice's points within the lags, the origin left out: of two opposite ones, and of those that are the same around
/// an exemplar that tiles, one.
std::vector<Vector2d> points_of(const Correlation& r, Vector2d a, Vector2d b) {
  std::vector<Vector2d> points;
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
  const double few = 1 - 1.3 / count;
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
    if (!than.has(p.at, 0.15)) own.push_back(p);
  if (own.size() < 2) return false;
  const Moments<1> on = moments(own), &other = than.on;
  if (on.mean() >= other.mean() * (1 - least_gap)) return false;
  const auto a = double(on.count()), b = double(other.count());
  const double least = 0.03 * other.mean();  // deviations of few points say little
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
    if ((rounded - *v).lpNorm<Eigen::Infinity>() > near_whole) return l;
    *v = rounded;
  }
  const double alike = whole.is_valid() ? on_points(r, whole) : 0;
  return alike >= least_alike_of_drawn && alike >= on_points(r, l) - no_difference ? whole : l;
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
    Candidate c = judged(r_, a, b, good_enough * highest_);
    if (c.score <= 0) return;
    highest_ = std::max(highest_, c.score);
    candidates_.push_back(std::move(c));
  }

  /// The densest that does not do worse than any other; null if there is none.
  const Candidate* best() {
    const double least = good_enough * highest_;
    candidates_.erase(
        std::remove_if(candidates_.begin(), candidates_.end(), [&](const Candidate& c) { return c.score < least; }),
        candidates_.end());
    std::stable_sort(candidates_.begin(), candidates_.end(),
                     [](const Candidate& a, const Candidate& b) { return a.area() < b.area(); });
    const Candidate* best = nullptr;
    for (const Candidate& c : candidates_) {
      if (best && c.area() > same_area * best->area()) break;
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
    return r_.wraps() ? least_errors : least_errors * (1 + 1.0 / double(c.on.count()));
  }

  /// Fits both vectors to peaks near them. An exemplar that tiles holds whole steps; false if it is far from that.
  bool fit(Vector2d& a, Vector2d& b) const {
    if (!r_.wraps()) {
      refine(r_, a, b, 2);
      return true;
    }
    if (b.squaredNorm() > longest * longest * a.squaredNorm()) return false;
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
  // Of few cells few peaks are seen; all the lattices can be tried. (Not those of two or three cells: exemplars that
  // were made to tile often hold parts of themselves twice.)
  for (int cells = fewest_around; r.wraps() && cells <= most_around; cells++)
    for (int across = 1; across <= cells; across++) {
      if (cells % across != 0) continue;
      const int down = cells / across;
      const double width = double(r.exemplar().width) / across, height = double(r.exemplar().height) / down;
      // Of whole shifts by the exemplar's width over all cells there are as many as rows (Hermite normal form).
      for (int shift = 0; shift < down; shift++) search.add({width, 0}, {width * shift / down, height});
    }
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

Lattice without_false_repeats(const Correlation& r, const Lattice& lattice) {
  if (lattice.rank != 2) return lattice;
  Vector2d a = lattice.first, b = lattice.second;
  reduce(a, b);
  const Candidate all = judged(r, a, b, -2);
  Lattice best = lattice;
  double largest = 0;
  for (int cells = 2; cells <= most_cells; cells++)
    for (int p = 1; p <= cells; p++) {
      if (cells % p != 0) continue;
      // Every sublattice of that many cells has a basis p * a, q * a + rows * b (Hermite normal form).
      for (int q = 0; q < p; q++) {
        const Candidate c = judged(r, p * a, q * a + cells / p * b, -2);
        if (c.on.count() < 3 || c.on.mean() <= 0 || !is_worse(all, c, least_errors_of_parts)) continue;
        // Of the correlation on the sublattice's points, what the others lack.
        const double gap = (1 - all.on.mean() / c.on.mean()) * cells / (cells - 1);
        if (gap <= largest + 0.05) continue;
        largest = gap;
        best.first = c.a;
        best.second = c.b;
      }
    }
  return best;
}

}  // namespace terrazzo
