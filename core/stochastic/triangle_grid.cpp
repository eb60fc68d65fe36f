#include "core/stochastic/triangle_grid.h"

#include <algorithm>
#include <cmath>

#include "core/base/portable_math.h"
#include "core/base/tuning.h"
#include "core/procedural/noise.h"

namespace terrazzo {

namespace {

struct TriangleGridTuning {
  int sharpness = 4;
};
const Tunable<TriangleGridTuning> triangle_grid_tuning(
    "triangle_grid", {
                         {&TriangleGridTuning::sharpness, "sharpness", "exponent",
                          "of the barycentric coordinates. Higher: more of the surface "
                          "shows one sample, with its features whole; lower: "
                          "softer transitions from sample to sample",
                          "noise_by_example", 1, 32},
                     });

constexpr double row_height = 0.86602540378443865;  ///< of an equilateral triangle, in edges

int64_t floor_div(int64_t a, int64_t b) {
  return a / b - (a % b < 0 ? 1 : 0);
}

int64_t floor_mod(int64_t a, int64_t b) {
  return a - floor_div(a, b) * b;
}

int64_t cells_of(int64_t pixels, int cell) {
  return (pixels + cell - 1) / cell;
}

double sharpened(double coordinate) {
  double weight = coordinate;
  for (int i = 1; i < triangle_grid_tuning->sharpness; i++) weight *= coordinate;
  return weight;
}

}  // namespace

TriangleGrid::TriangleGrid(int cell, const GridSurface& surface, uint64_t seed)
    : x_{cell, 1, false}, reach_x_(cell), reach_y_(std::max(1, int(cell * row_height + 0.5))), seed_(seed) {
  y_ = {reach_y_, 1, false};
  if (surface.wraps_x) x_ = {surface.size.width, cells_of(surface.size.width, reach_x_), true};
  // Rows are shifted by half a cell: after an even number of them the grid repeats.
  if (surface.wraps_y) y_ = {surface.size.height, 2 * cells_of(surface.size.height, 2 * reach_y_), true};
}

GridVertex TriangleGrid::vertex(int64_t column, int64_t row, int64_t x, int64_t y, double coordinate) const {
  // Vertex (column, row) lies at (column + row / 2, row) cells. Whole numbers: places one period apart agree exactly.
  const int64_t at_x = floor_div((2 * column + row) * x_.pixels, 2 * x_.cells);
  const int64_t at_y = floor_div(row * y_.pixels, y_.cells);
  if (y_.wraps) {
    const int64_t turns = floor_div(row, y_.cells);
    row -= turns * y_.cells;
    column += turns * (y_.cells / 2);
  }
  if (x_.wraps) column = floor_mod(column, x_.cells);
  return {lattice_bits(seed_, column, row), int(x - at_x), int(y - at_y), sharpened(coordinate)};
}

std::array<GridVertex, 3> TriangleGrid::around(int64_t x, int64_t y) const {
  if (x_.wraps) x = floor_mod(x, x_.pixels);
  if (y_.wraps) y = floor_mod(y, y_.pixels);
  const double v = double(y * y_.cells) / double(y_.pixels);
  const double u = double(x * x_.cells) / double(x_.pixels) - 0.5 * v;
  const int64_t i = portable::floor_int(u), j = portable::floor_int(v);
  const double fu = u - double(i), fv = v - double(j), rest = 1 - fu - fv;
  std::array<GridVertex, 3> all =
      rest >= 0 ? std::array{vertex(i, j, x, y, rest), vertex(i + 1, j, x, y, fu), vertex(i, j + 1, x, y, fv)}
                : std::array{vertex(i + 1, j + 1, x, y, -rest), vertex(i, j + 1, x, y, 1 - fu),
                             vertex(i + 1, j, x, y, 1 - fv)};
  double squares = 0;
  for (const GridVertex& g : all) squares += g.weight * g.weight;
  const double scale = 1 / std::sqrt(squares);
  for (GridVertex& g : all) g.weight *= scale;
  return all;
}

}  // namespace terrazzo
