#include "core/lattice.h"

#include <algorithm>
#include <array>
#include <limits>

namespace terrazzo {

namespace {

constexpr double smallest_resolved = 3;  // pixels of the level
constexpr double smallest_cell = 0.3;
// How far out of phase a position may be, in cells, and how much of that a certain lattice takes away: the surer the
// lattice, the less its cells differ from one another.
constexpr double looseness = 1.0 / 12;
constexpr double certainty_counts = 2.0 / 3;

using Steps = std::array<std::array<int, 2>, 49>;

/// To all pixels up to three away along each axis, the nearest first.
const Steps& nearest_steps() {
  static const Steps steps = [] {
    Steps s{};
    for (int i = 0; i < int(s.size()); i++) s[i] = {i % 7 - 3, i / 7 - 3};
    std::stable_sort(s.begin(), s.end(), [](const auto& a, const auto& b) {
      return a[0] * a[0] + a[1] * a[1] < b[0] * b[0] + b[1] * b[1];
    });
    return s;
  }();
  return steps;
}

}  // namespace

Lattice Lattice::fitted(Size size, bool wraps_x, bool wraps_y) const {
  const auto whole = [](double cells, bool wraps) { return wraps ? std::floor(cells + 0.5) : cells; };
  const double w = size.width, h = size.height;
  Lattice out = *this;
  if (rank == 1) {
    const bool columns = first.x != 0;
    const double length = columns ? w : h;
    const double cells = whole(length / (columns ? first.x : first.y), columns ? wraps_x : wraps_y);
    if (std::abs(cells) >= 1) (columns ? out.first.x : out.first.y) = length / cells;
  }
  if (rank == 2) {
    // Column by column, the cells that the surface spans along x and along y; its inverse gives the vectors.
    const double d = 1.0 / (first.x * second.y - first.y * second.x);
    const double ix = whole(second.y * d * w, wraps_x), jx = whole(-first.y * d * w, wraps_x);
    const double iy = whole(-second.x * d * h, wraps_y), jy = whole(first.x * d * h, wraps_y);
    const double spanned = ix * jy - iy * jx;
    if (std::abs(spanned) >= 0.5) {
      out.first = {w * jy / spanned, -h * jx / spanned};
      out.second = {-w * iy / spanned, h * ix / spanned};
    }
  }
  return out;
}

bool Lattice::fits(Size size, bool wraps_x, bool wraps_y) const {
  if (rank == 0) return true;
  const Lattice to = fitted(size, wraps_x, wraps_y);
  // How far a step of one cell is off, times the steps that cross the surface.
  const auto drift = [&](const Vector2& a, const Vector2& b) {
    const double length = std::max(std::abs(a.x), std::abs(a.y));
    return length > 0 ? std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)) * std::max(size.width, size.height) / length
                      : 0.0;
  };
  return drift(first, to.first) <= 1 && drift(second, to.second) <= 1;
}

Size Lattice::largest_fitting(Size size, bool wraps_x, bool wraps_y) const {
  // How far (x, y) is from the next place at which the exemplar comes back to itself.
  const LatticePhase phase(*this, 0, size, false, false);
  const auto largest = [&](int length, int dx, int dy) {
    for (int n = length; 2 * n > length; n--) {
      const Vector2 e = phase.excess(n * dx, n * dy, 0, 0);
      if (std::max(std::abs(e.x), std::abs(e.y)) <= 0.5) return n;
    }
    return length;
  };
  if (!phase.active()) return size;
  return {wraps_x ? largest(size.width, 1, 0) : size.width, wraps_y ? largest(size.height, 0, 1) : size.height};
}

LatticePhase::Matrix LatticePhase::to_cells(const Lattice& l, double scale) {
  const double ax = l.first.x * scale, ay = l.first.y * scale, bx = l.second.x * scale, by = l.second.y * scale;
  if (l.rank == 1) return ax != 0 ? Matrix{1 / ax, 0, 0, 0} : Matrix{0, 1 / ay, 0, 0};
  const double d = 1.0 / (ax * by - ay * bx);
  return {by * d, -bx * d, -ay * d, ax * d};
}

LatticePhase::LatticePhase(const Lattice& lattice, int level, Size output, bool tile_x, bool tile_y,
                           const Vector2& origin)
    : rank_(lattice.rank) {
  if (rank_ == 0) return;
  const double scale = 1.0 / double(int64_t{1} << level);
  first_ = {lattice.first.x * scale, lattice.first.y * scale};
  second_ = {lattice.second.x * scale, lattice.second.y * scale};
  const double cell =
      rank_ == 1 ? std::abs(first_.x + first_.y) : std::sqrt(std::abs(first_.x * second_.y - first_.y * second_.x));
  resolves_cells_ = cell >= smallest_resolved;
  if (cell < smallest_cell) rank_ = 0;
  const double loose = cell * looseness * (1 - lattice.certainty * certainty_counts);
  // Whole pixels of the finest level are out of phase by up to half a pixel along each axis that the lattice speaks of.
  const double rounding = (rank_ == 1 ? 0.501 : 0.708) * scale;
  const double tolerance = std::clamp(loose, rounding, 1.0);
  stiffness_ = 1 / (tolerance * tolerance);
  to_exemplar_ = to_cells(lattice, scale);
  to_output_ = to_cells(lattice.fitted(output, tile_x, tile_y), scale);
  const double x = origin.x * scale, y = origin.y * scale;
  origin_ = {to_output_.xx * x + to_output_.xy * y, to_output_.yx * x + to_output_.yy * y};
}

void LatticePhase::search(int x, int y, int& u, int& v) const {
  constexpr double far = 0.001;  // settles which of several in phase
  double least = std::numeric_limits<double>::max();
  const int from_u = u, from_v = v;
  for (const auto& [dx, dy] : nearest_steps()) {
    // Along courses every place is as good as the next.
    if (rank_ == 1 && (first_.x == 0 ? dx : dy) != 0) continue;
    const double misfit = penalty(from_u + dx, from_v + dy, x, y);
    const double cost = misfit + far * (dx * dx + dy * dy);
    if (cost >= least) continue;
    least = cost;
    u = from_u + dx;
    v = from_v + dy;
    if (misfit == 1) break;  // those further off cost more
  }
}

}  // namespace terrazzo
