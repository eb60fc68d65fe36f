#include "core/analysis/regularity.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "core/analysis/few_cells.h"
#include "core/analysis/lag_correlation.h"
#include "core/analysis/planes.h"

namespace terrazzo {

namespace {

constexpr int most_side = 256;     // periods are found to a fraction of a pixel; more resolution brings nothing
constexpr int smallest_side = 16;  // less has no room for repeats
constexpr double shortest = 4;     // pixels; anything finer is grain
constexpr int most_peaks = 60;
constexpr double good_enough = 0.75;  // of the best score
constexpr double clearly_better = 0.3;
constexpr double about = 0.05;  // scores that differ by less are as good as equal
// Of what correlation remains between bands, the part that must repeat along them before bricks count as of one length.
constexpr double least_bond = 0.25;

struct Peak {
  Vector2 at;
  double value;
};

std::vector<Peak> strongest_peaks(const Correlation& r) {
  std::vector<Peak> peaks;
  for (int y = 0; y < r.lags().height - 3; y++)
    for (int x = y == 0 ? 1 : 4 - r.lags().width; x < r.lags().width - 3; x++) {
      if (x * x + y * y < shortest * shortest) continue;
      const double v = r.at(x, y);
      bool highest = v > 0.02;
      for (int j = -2; j <= 2 && highest; j++)
        for (int i = -2; i <= 2 && highest; i++) highest = r.at(x + i, y + j) <= v;
      if (highest) peaks.push_back({r.peak_near({double(x), double(y)}).first, v});
    }
  // Nearer peaks first among equals: small cells are tried before their multiples.
  std::stable_sort(peaks.begin(), peaks.end(), [](const Peak& a, const Peak& b) { return a.value > b.value; });
  if (peaks.size() > most_peaks) peaks.resize(most_peaks);
  return peaks;
}

/// Correlation on the lattice's points shifted by (si, sj) cells, within the lags.
std::vector<double> values_on(const Correlation& r, Vector2 a, Vector2 b, double si, double sj) {
  std::vector<double> values;
  for (int i = -24; i <= 24; i++)
    for (int j = 0; j <= 24; j++) {
      const Vector2 d{(i + si) * a.x + (j + sj) * b.x, (i + si) * a.y + (j + sj) * b.y};
      if ((i + si != 0 || j + sj != 0) && r.covers(d.x, d.y)) values.push_back(r.at(d));
    }
  return values;
}

/// Whether enough points lie off each vector's own line: a line and a chance point make no lattice.
bool leads_both_ways(const Correlation& r, Vector2 a, Vector2 b) {
  int off_a = 0, off_b = 0;
  for (int i = -24; i <= 24; i++)
    for (int j = 0; j <= 24; j++) {
      if (!r.covers(i * a.x + j * b.x, i * a.y + j * b.y)) continue;
      off_a += j != 0;
      off_b += i != 0;
    }
  return off_a >= 4 && off_b >= 4;
}

/// How far the lattice's points stand out. Nearly all must: chance alignments have some good points, a lattice has no
/// bad ones.
double lattice_score(const Correlation& r, Vector2 a, Vector2 b) {
  std::vector<double> on = values_on(r, a, b, 0, 0);
  if (on.size() < 6 || !leads_both_ways(r, a, b)) return -1;
  const auto low = on.begin() + ptrdiff_t(on.size() / 8);
  std::nth_element(on.begin(), low, on.end());
  double off = 0;
  for (const auto& [si, sj] : {std::pair{0.5, 0.0}, {0.0, 0.5}, {0.5, 0.5}}) {
    const std::vector<double> between = values_on(r, a, b, si, sj);
    double sum = 0;
    for (const double v : between) sum += v;
    if (!between.empty()) off = std::max(off, sum / double(between.size()));
  }
  return *low - off;
}

/// Fits both vectors to all peaks near the lattice's points, out to the farthest.
void refine(const Correlation& r, Vector2& a, Vector2& b) {
  for (int reach = 2; reach <= 24; reach *= 2) {
    double ii = 0, ij = 0, jj = 0;
    Vector2 pi, pj;
    for (int i = -reach; i <= reach; i++)
      for (int j = -reach; j <= reach; j++) {
        const Vector2 d{i * a.x + j * b.x, i * a.y + j * b.y};
        if ((i == 0 && j == 0) || !r.covers(d.x, d.y)) continue;
        const auto [p, value] = r.peak_near(d);
        const double w = std::max(0.0, value);
        ii += w * i * i;
        ij += w * i * j;
        jj += w * j * j;
        pi = {pi.x + w * i * p.x, pi.y + w * i * p.y};
        pj = {pj.x + w * j * p.x, pj.y + w * j * p.y};
      }
    const double determinant = ii * jj - ij * ij;
    if (determinant <= 1e-9 * ii * jj) return;
    a = {(pi.x * jj - pj.x * ij) / determinant, (pi.y * jj - pj.y * ij) / determinant};
    b = {(pj.x * ii - pi.x * ij) / determinant, (pj.y * ii - pi.y * ij) / determinant};
  }
}

Lattice two_directions(const Correlation& r) {
  const std::vector<Peak> peaks = strongest_peaks(r);
  struct Candidate {
    Vector2 a, b;
    double area, score;
  };
  std::vector<Candidate> candidates;
  double highest = 0;
  for (size_t p = 0; p < peaks.size(); p++)
    for (size_t q = p + 1; q < peaks.size(); q++) {
      const Vector2 a = peaks[p].at, b = peaks[q].at;
      const double area = std::abs(a.x * b.y - a.y * b.x);
      const double lengths = std::sqrt((a.x * a.x + a.y * a.y) * (b.x * b.x + b.y * b.y));
      if (area < 0.4 * lengths) continue;
      candidates.push_back({a, b, area, lattice_score(r, a, b)});
      highest = std::max(highest, candidates.back().score);
    }
  // Multiples of a cell score about as well as the cell itself, or better where they fall on whole pixels: take the
  // smallest of those that do well.
  Lattice best;
  double least_area = std::numeric_limits<double>::max();
  for (const Candidate& c : candidates)
    if (c.score >= good_enough * highest && c.score > 0 && c.area < 0.98 * least_area) {
      best = {2, c.a, c.b, c.score};
      least_area = c.area;
    }
  if (best.rank == 2) refine(r, best.first, best.second);
  return best;
}

/// Bands across one axis: correlation averaged along them.
Lattice one_direction(const Correlation& r, bool courses) {
  const int across = (courses ? r.lags().height : r.lags().width) - 3;
  const int along = (courses ? r.lags().width : r.lags().height) / 2;
  std::vector<double> profile(across);
  for (int d = 0; d < across; d++) {
    for (int t = -along; t <= along; t++) profile[d] += courses ? r.at(t, d) : r.at(d, t);
    profile[d] /= 2 * along + 1;
  }
  const auto sample = [&](double d) {
    const int i = int(d);
    return profile[i] + (d - i) * (profile[std::min(across - 1, i + 1)] - profile[i]);
  };
  const auto score = [&](double period) {
    double on = 0, off = 0;
    int count = 0;
    for (double d = period; d < across - 1; d += period, count++) {
      on += sample(d);
      off += sample(d - period / 2);
    }
    return count >= 2 ? (on - off) / count : -1.0;
  };
  double best_period = 0, certainty = 0;
  for (double period = shortest; period <= across / 2.5; period += 0.1)
    if (const double c = score(period); c > certainty + 0.005) {
      best_period = period;
      certainty = c;
    }
  if (certainty <= 0) return {};
  for (int step = -20; step <= 20; step++)
    if (const double c = score(best_period + 0.005 * step); c > certainty) {
      certainty = c;
      best_period += 0.005 * step;
      step = -20;
    }
  return {1, courses ? Vector2{0, best_period} : Vector2{best_period, 0}, {}, certainty};
}

/// Bricks in courses: whether what remains of the correlation, once the bands themselves are taken out, repeats along
/// them too, each band shifted against the next by a usual bond.
Lattice with_bond(const Correlation& r, const Lattice& bands) {
  const bool courses = bands.first.x == 0;
  const double period = courses ? bands.first.y : bands.first.x;
  const int along = (courses ? r.lags().width : r.lags().height) - 3,
            across = (courses ? r.lags().height : r.lags().width) - 3;
  const int band_count = std::min(6, int((across - 1) / period));
  // One row of remaining correlation per band; lag 0 stands in the middle.
  std::vector<std::vector<double>> rows;
  for (int j = 0; j <= band_count; j++) {
    const int d = int(std::floor(j * period + 0.5));
    std::vector<double> row;
    double mean = 0;
    for (int t = -along; t <= along; t++) {
      row.push_back(courses ? r.at(t, d) : r.at(d, t));
      mean += row.back() / (2 * along + 1);
    }
    for (double& v : row) v -= mean;
    rows.push_back(std::move(row));
  }
  const double unit = rows[0][along];
  if (unit <= 0.02) return bands;
  const auto score = [&](double length, double shift) {
    double sum[2] = {0, 0};
    int count[2] = {0, 0};
    for (int j = 0; j <= band_count; j++)
      for (int i = -60; i <= 60; i++) {
        const double at = (i * 0.5 + j * shift) * length;
        if (std::abs(at) > along - 1 || (j == 0 && i == 0)) continue;
        sum[i & 1] += rows[j][size_t(int(std::floor(at + 0.5)) + along)];
        count[i & 1]++;
      }
    return count[0] < 6 || count[1] < 6 ? 0.0 : (sum[0] / count[0] - sum[1] / count[1]) / unit;
  };
  double best = least_bond, best_length = 0, best_shift = 0;
  // Shorter bricks first: a multiple must be clearly better.
  for (double length = std::max(shortest, period / 2); length < along / 1.5; length += 0.25)
    for (const double shift : {0.0, 1 / 2.0, 1 / 3.0, 2 / 3.0, 1 / 4.0, 3 / 4.0})
      if (const double c = score(length, shift);
          c > best * (length > 1.5 * best_length && best_length > 0 ? 1.3 : 1.0)) {
        best = c;
        best_length = length;
        best_shift = shift;
      }
  if (best_length == 0) return bands;
  Lattice bond{2, {best_length, 0}, {best_shift * best_length, period}, bands.certainty};
  if (!courses) bond = {2, {0, best_length}, {period, best_shift * best_length}, bands.certainty};
  refine(r, bond.first, bond.second);
  return bond;
}

/// The lattice, or the one of up to six times as large a cell that the correlation follows much better: in a
/// herringbone the joints lie on a grid, but only some of the grid's points repeat the bricks.
Lattice without_false_repeats(const Correlation& r, const Lattice& l) {
  if (l.rank != 2) return l;
  Lattice best = l;
  double largest = clearly_better;
  for (int cells = 2; cells <= 6; cells++)
    for (int p = 1; p <= cells; p++) {
      if (cells % p != 0) continue;
      const int rows = cells / p;
      // Every sublattice of that many cells has a basis p * first, q * first + rows * second (Hermite normal form).
      for (int q = 0; q < p; q++) {
        double on = 0, off = 0;
        int on_count = 0, off_count = 0;
        for (int j = 0; j <= 24; j++)
          for (int i = j == 0 ? 1 : -24; i <= 24; i++) {
            const Vector2 d{i * l.first.x + j * l.second.x, i * l.first.y + j * l.second.y};
            if (!r.covers(d.x, d.y)) continue;
            const bool member = j % rows == 0 && (i - q * (j / rows)) % p == 0;
            (member ? on : off) += r.peak_near(d).second;
            (member ? on_count : off_count)++;
          }
        if (on_count < 4 || off_count < 4 || on <= 0) continue;
        const double gap = 1 - (off / off_count) / (on / on_count);
        if (gap <= largest) continue;
        largest = gap;
        best.first = {p * l.first.x, p * l.first.y};
        best.second = {q * l.first.x + rows * l.second.x, q * l.first.y + rows * l.second.y};
      }
    }
  return best;
}

/// Upright grids before skew lattices before bands, each where it explains about as much as the next.
Lattice most_telling(const Correlation& r, double least_certainty) {
  const Lattice courses = one_direction(r, true), columns = one_direction(r, false);
  const Lattice skew = two_directions(r);
  const double both = std::min(courses.certainty, columns.certainty);
  // Lines that come again halfway along one axis do not make half cells.
  const double grid = both >= least_certainty ? lattice_score(r, columns.first, courses.first) : -1;
  if (grid >= std::max(both / 2, skew.certainty - about)) return {2, columns.first, courses.first, both};
  const Lattice& bands = courses.certainty > columns.certainty ? courses : columns;
  // What bands explain, any skew lattice that respects them explains too, up to a half.
  if (skew.certainty >= std::max(least_certainty, bands.certainty / 2)) return skew;
  return bands.certainty >= least_certainty ? with_bond(r, bands) : bands;
}

Lattice searched(const ExemplarPlanes& planes, double least_certainty, const Task& task) {
  const Correlation r = correlate(planes, task);
  const Lattice best = without_false_repeats(r, most_telling(r, least_certainty));
  if (!planes.wraps) return best;
  // Several cells together do about as well as one.
  const Lattice few = lattice_of_few_cells(r, planes.size);
  return good_enough * few.certainty > best.certainty ? few : best;
}

}  // namespace

Lattice find_lattice(const Features& features, double least_certainty, const Task& task) {
  if (std::min(features.size().width, features.size().height) < smallest_side) return {};
  ExemplarPlanes planes = weighted_planes(features, task);
  double scale = 1;
  while (std::max(planes.size.width, planes.size.height) > most_side) {
    planes = halved(planes);
    scale *= 2;
  }
  // What repeats may be the colours or, where those vary from brick to brick, only the joints.
  Lattice best = searched(planes, least_certainty, task);
  const ExemplarPlanes edges = outlines(planes);
  const Lattice joints = searched(edges, least_certainty, task);
  if (joints.certainty > best.certainty) best = joints;
  if (best.certainty < least_certainty || !best.is_valid()) best = {0, {}, {}, best.certainty};
  if (planes.wraps) {
    const Lattice lines = lattice_of_lines(edges, best);
    if (lines.rank > 0) best = lines;
  }
  if (best.rank == 0) return best;
  for (Vector2* v : {&best.first, &best.second}) *v = {v->x * scale, v->y * scale};
  return best.fitted(features.size(), features.wraps(), features.wraps());
}

}  // namespace terrazzo
