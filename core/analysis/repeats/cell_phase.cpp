#include "core/analysis/repeats/cell_phase.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <tbb/parallel_for.h>

#include "core/analysis/repeats/lag_correlation.h"
#include "core/base/geometry.h"

namespace terrazzo {

namespace {

// Along a step. Phases are found to a fraction of a bin, and time grows with the fourth power of their number.
constexpr int fewest_bins = 8, most_bins = 48;

struct Bins {
  int columns = 1, rows = 1;
};

/// About one to a pixel.
Bins bins_of(const RepeatingView& r) {
  const auto along = [&](const Vector2d& step) {
    return std::max(fewest_bins, std::min(int(std::ceil(step.norm() / r.view.scale)), most_bins));
  };
  return {along(r.lattice.first), r.lattice.rank == 2 ? along(r.lattice.second) : 1};
}

/// The mean of all cells, by place within the cell: channels from which their own mean is taken away.
struct MeanCell {
  Bins bins;
  int channels = 0;
  std::vector<double> values;
  std::vector<uint8_t> seen;  // per bin

  const double* at(int column, int row) const {
    return &values[size_t(row * bins.columns + column) * size_t(channels)];
  }
  bool is_seen(int column, int row) const { return seen[size_t(row * bins.columns + column)] != 0; }
};

MeanCell mean_cell(const Planes& planes, const RepeatingView& of, Bins bins) {
  MeanCell out{bins, planes.channels, {}, {}};
  const int n = planes.channels;
  out.values.assign(size_t(bins.columns * bins.rows * n), 0);
  std::vector<int> counts(size_t(bins.columns * bins.rows));
  const ExemplarView& view = of.view;
  // Of steps of whole pixels every pixel lies on the border of two bins, and must not fall into either as it happens.
  constexpr double hardly = 1e-6;
  const auto bin = [](double cells, int count) { return wrap(int(std::floor(cells * count + hardly)), count); };
  for (int y = 0; y < planes.size.height; y++)
    for (int x = 0; x < planes.size.width; x++) {
      if (!view.counts.values.empty() && *view.counts.at(x, y) < 1) continue;
      const Vector2d cells =
          of.lattice.cells({(x + 0.5) * view.scale - 0.5 + view.seen.x, (y + 0.5) * view.scale - 0.5 + view.seen.y});
      const size_t at = size_t(bin(cells.y(), bins.rows) * bins.columns + bin(cells.x(), bins.columns));
      counts[at]++;
      for (int c = 0; c < n; c++) out.values[at * size_t(n) + size_t(c)] += double(planes.at(x, y)[c]);
    }
  std::vector<double> mean(size_t(n), 0.0);
  int seen = 0;
  for (size_t b = 0; b < counts.size(); b++) {
    if (counts[b] == 0) continue;
    seen++;
    for (int c = 0; c < n; c++) mean[size_t(c)] += out.values[b * size_t(n) + size_t(c)] /= counts[b];
  }
  for (size_t b = 0; b < counts.size(); b++) {
    out.seen.push_back(counts[b] > 0);
    for (int c = 0; c < n && counts[b] > 0; c++) out.values[b * size_t(n) + size_t(c)] -= mean[size_t(c)] / seen;
  }
  return out;
}

/// How alike two mean cells are, -1..1, with the other one moved.
double likeness(const MeanCell& a, const MeanCell& b, int columns, int rows) {
  double product = 0, squares_a = 0, squares_b = 0;
  for (int y = 0; y < a.bins.rows; y++) {
    const int v = wrap(y + rows, a.bins.rows);
    for (int x = 0; x < a.bins.columns; x++) {
      const int u = wrap(x + columns, a.bins.columns);
      if (!a.is_seen(x, y) || !b.is_seen(u, v)) continue;
      const double *p = a.at(x, y), *q = b.at(u, v);
      for (int c = 0; c < a.channels; c++) {
        product += p[c] * q[c];
        squares_a += p[c] * p[c];
        squares_b += q[c] * q[c];
      }
    }
  }
  const double size = std::sqrt(squares_a * squares_b);
  return size > 0 ? product / size : 0;
}

}  // namespace

Vector2d phase_between(const RepeatingView& first, const RepeatingView& other, const Task& task) {
  const Bins bins = bins_of(first);
  const Planes edges = outlines(first.view.planes, task), other_edges = outlines(other.view.planes, task);
  const MeanCell values = mean_cell(first.view.planes, first, bins), lines = mean_cell(edges, first, bins);
  const MeanCell other_values = mean_cell(other.view.planes, other, bins),
                 other_lines = mean_cell(other_edges, other, bins);
  const auto alike = [&](int column, int row) {
    return likeness(values, other_values, column, row) + likeness(lines, other_lines, column, row);
  };
  std::vector<double> likenesses(size_t(bins.columns * bins.rows));
  tbb::parallel_for(0, bins.rows, [&](int y) {
    for (int x = 0; x < bins.columns; x++) likenesses[size_t(y * bins.columns + x)] = alike(x, y);
  });
  const auto best = int(std::ranges::max_element(likenesses) - likenesses.begin());
  const int column = best % bins.columns, row = best / bins.columns;
  const auto near = [&](int x, int y) {
    return likenesses[size_t(wrap(y, bins.rows) * bins.columns + wrap(x, bins.columns))];
  };
  const double most = near(column, row);
  const double x = column + vertex_near(near(column - 1, row), most, near(column + 1, row));
  const double y = bins.rows == 1 ? 0 : row + vertex_near(near(column, row - 1), most, near(column, row + 1));
  return {x / bins.columns, y / bins.rows};
}

}  // namespace terrazzo
