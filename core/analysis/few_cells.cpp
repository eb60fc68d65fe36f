#include "core/analysis/few_cells.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace terrazzo {

namespace {

constexpr int fewest_cells = 4, most_cells = 12;
constexpr double least_few = 0.2;  // what cells must correlate more than places between them
// Of all variance, what differs from line to line. Layers of rock have up to a tenth, along one axis.
constexpr double least_crossing = 0.1, least_parallel = 0.4;
constexpr int most_repeats = 8;      // of lines in an exemplar
constexpr double same_lines = 0.7;   // correlation of lines that repeat
constexpr double other_lines = 0.3;  // and of those that do not

/// Correlation at a lag of an exemplar that wraps around.
double around(const Correlation& r, Size size, double x, double y) {
  x -= size.width * std::floor(x / size.width + 0.5);
  y -= size.height * std::floor(y / size.height + 0.5);
  return r.peak_near({x, y}).second;
}

/// How far the points of the lattice with `across` times `down` cells, each row of them shifted by `shift` of a cell,
/// stand out against those half a cell off.
double standing_out(const Correlation& r, Size size, int across, int down, double shift) {
  const double width = double(size.width) / across, height = double(size.height) / down;
  const auto at = [&](double i, double j) { return around(r, size, (i + j * shift) * width, j * height); };
  double on = 1, off = -1;
  for (int j = 0; j < down; j++)
    for (int i = 0; i < across; i++)
      if (i + j > 0) on = std::min(on, at(i, j));
  for (const auto& [half_i, half_j] : {std::pair{0.5, 0.0}, {0.0, 0.5}, {0.5, 0.5}}) {
    double sum = 0;
    for (int j = 0; j < down; j++)
      for (int i = 0; i < across; i++) sum += at(i + half_i, j + half_j);
    off = std::max(off, sum / (across * down));
  }
  return on - off;
}

/// What of all variance is differences between lines along one axis, and after how many pixels lines come again.
struct Lines {
  double share = 0;
  double period = 0;
  std::vector<double> profile;
};

double correlation_around(const std::vector<double>& profile, double lag) {
  const auto n = int(profile.size());
  const auto at_lag = [&](int d) {
    double sum = 0;
    for (int i = 0; i < n; i++) sum += profile[i] * profile[(i + d) % n];
    return sum;
  };
  const int d = int(std::floor(lag + 0.5));
  const double most = std::max({at_lag(d + n - 1), at_lag(d), at_lag(d + 1)});
  return most / std::max(1e-12, at_lag(0));
}

Lines lines_of(const ExemplarPlanes& plane, bool rows) {
  const int width = plane.size.width, height = plane.size.height;
  const double mean = std::accumulate(plane.values.begin(), plane.values.end(), 0.0) / double(plane.values.size());
  std::vector<double> profile(size_t(rows ? height : width), 0.0);
  double variance = 0;
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      const double v = plane.values[size_t(y) * width + x] - mean;
      variance += v * v;
      profile[size_t(rows ? y : x)] += v;
    }
  const double length = rows ? width : height, count = double(profile.size());
  double between = 0;
  for (const double v : profile) between += v * v / length;
  Lines out{between / std::max(1e-12, variance), count, profile};
  for (int n = 2; n <= most_repeats; n++) {
    double least = 1;
    for (int k = 1; k < n; k++) least = std::min(least, correlation_around(profile, k * count / n));
    if (least >= same_lines) out.period = count / n;
  }
  return out;
}

}  // namespace

Lattice lattice_of_few_cells(const Correlation& r, Size size) {
  Lattice best;
  best.certainty = least_few;
  for (int cells = most_cells; cells >= fewest_cells; cells--)
    for (int across = 1; across <= cells; across++) {
      if (cells % across != 0) continue;
      const int down = cells / across;
      // Of whole shifts by the exemplar's width over all cells there are as many as rows (Hermite normal form).
      for (int shift = 0; shift < down; shift++) {
        const double part = double(shift) / down;
        const double certainty = standing_out(r, size, across, down, part);
        if (certainty <= best.certainty) continue;
        const double width = double(size.width) / across;
        best = {2, {width, 0}, {part * width, double(size.height) / down}, certainty};
      }
    }
  return best.rank > 0 ? best : Lattice{};
}

Lattice lattice_of_lines(const ExemplarPlanes& outlines, const Lattice& found) {
  const Lines rows = lines_of(outlines, true), columns = lines_of(outlines, false);
  const Vector2 down{0, rows.period}, right{columns.period, 0};
  const bool courses = rows.share >= least_parallel;
  const double both = std::min(rows.share, columns.share);
  if (found.rank < 2 && both >= std::max(least_crossing, found.certainty)) return {2, right, down, both};
  const Lines& lines = courses ? rows : columns;
  if (lines.share < least_parallel || found.rank > 1) return {};
  // Bands found otherwise stay, unless lines deny them.
  const double period = courses ? found.first.y : found.first.x;
  if (found.rank == 1 && (period == 0 || correlation_around(lines.profile, period) > other_lines)) return {};
  return {1, courses ? down : right, {}, lines.share};
}

}  // namespace terrazzo
