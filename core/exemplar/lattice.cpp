#include "core/exemplar/lattice.h"

#include <algorithm>
#include <array>
#include <limits>

namespace terrazzo {

namespace {

constexpr double smallest_resolved = 3;  // pixels of the level
// Pixels larger than two cells show nothing of them, and of so few in phase the same rows would come back all over a
// large surface. There anything goes: finer levels bring pieces into place.
constexpr double smallest_cell = 0.5;
// By how much a surface may be sheared to wrap around, as a part of its side, and in pixels where it is small: rows of
// a woven or scanned exemplar are rarely exactly level. Of pieces of 64 pixels this moves one end by a quarter of a
// pixel against the other, however large the surface.
constexpr double most_shear = 1.0 / 256;
constexpr double least_shear = 1;
// How far out of phase a position may be, in cells, and how much of that a certain lattice takes away: the surer the
// lattice, the less its cells differ from one another.
constexpr double looseness = 1.0 / 12;
constexpr double certainty_counts = 2.0 / 3;

constexpr double most_slanted = 0.02;  // of level courses: what they rise by, as a part of their length

// Of sizes that wrap: a side that is half as long again is as bad as cells bent by a fifth.
constexpr double bending_weight = 2;

/// The length of a side, near `length`, that wraps best.
int best_side(const Lattice& lattice, int length, bool along_x, int give) {
  int best = length;
  double least = std::numeric_limits<double>::max();
  for (int n = length / 2 + 1; n <= length + length / 8; n++) {
    const int room = give + std::max(0, n - length);
    const double bent = lattice.bent({n, n}, along_x, !along_x, {room, room});
    if (bent > Lattice::most_bent && n != length) continue;
    const double badness = std::abs(std::log(double(n) / length)) + bending_weight * bent;
    if (badness >= least) continue;
    least = badness;
    best = n;
  }
  return best;
}

}  // namespace

bool Lattice::is_whole() const {
  constexpr double rounding = 1e-6;
  const auto whole = [](double v) { return std::abs(v - std::floor(v + 0.5)) < rounding; };
  return rank == 2 && whole(first.x) && whole(first.y) && whole(second.x) && whole(second.y);
}

Vector2 Lattice::along_bands(bool courses) const {
  if (rank == 1) return (first.x == 0) == courses ? courses ? Vector2{1, 0} : Vector2{0, 1} : Vector2{};
  if (rank == 0) return {};
  constexpr int farthest = 3;
  Vector2 shortest;
  for (int i = -farthest; i <= farthest; i++)
    for (int j = -farthest; j <= farthest; j++) {
      const Vector2 v = at({double(i), double(j)});
      const double along = courses ? v.x : v.y, across = std::abs(courses ? v.y : v.x);
      const double least = courses ? shortest.x : shortest.y;
      if (along > 0 && across <= most_slanted * along && (least == 0 || along < least)) shortest = v;
    }
  return shortest;
}

Lattice Lattice::level_bands(bool courses) const {
  if (rank == 1) return (first.x == 0) == courses ? *this : Lattice{};
  const Vector2 along = along_bands(courses);
  const double length = courses ? along.x : along.y;
  if (length == 0) return {};
  const double period = cell_area() / length;
  return {1, courses ? Vector2{0, period} : Vector2{period, 0}, {}, certainty};
}

double Lattice::longest_step() const {
  if (rank != 2) return 0;
  // Next to nothing is what measuring leaves of nothing.
  constexpr double least = 2;
  const auto nearer = [](double a, double b) {
    a = std::abs(a);
    b = std::abs(b);
    return std::min(a, b) >= least ? std::min(a, b) : std::max(a, b);
  };
  return cell_area() / std::max(least, std::min(nearer(first.x, second.x), nearer(first.y, second.y)));
}

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

bool Lattice::fits(Size size, bool wraps_x, bool wraps_y, double precision) const {
  const auto comes_back = [&](int length, bool along_x) {
    const Vector2 e = misfit(length, along_x);
    const double along = std::abs(along_x ? e.x : e.y), across = std::abs(along_x ? e.y : e.x);
    return along <= precision && across <= std::max(least_shear, most_shear * length);
  };
  return (!wraps_x || comes_back(size.width, true)) && (!wraps_y || comes_back(size.height, false));
}

Vector2 Lattice::cells(const Vector2& at) const {
  if (rank == 1) return {first.x != 0 ? at.x / first.x : at.y / first.y, 0};
  const double d = 1.0 / (first.x * second.y - first.y * second.x);
  return {(second.y * at.x - second.x * at.y) * d, (first.x * at.y - first.y * at.x) * d};
}

Vector2 Lattice::misfit(int length, bool along_x) const {
  if (rank == 0) return {};
  const auto part = [](double cells) { return cells - std::floor(cells + 0.5); };
  const Vector2 c = cells(along_x ? Vector2{double(length), 0} : Vector2{0, double(length)});
  const double i = part(c.x), j = part(c.y);
  if (rank == 1) return at({i, 0});
  // In a skewed cell the nearest corner need not be the one that both parts round to.
  Vector2 least{};
  double shortest = std::numeric_limits<double>::max();
  for (const double p : {i, i - std::copysign(1, i)})
    for (const double q : {j, j - std::copysign(1, j)}) {
      const Vector2 v = at({p, q});
      if (v.length() >= shortest) continue;
      shortest = v.length();
      least = v;
    }
  return least;
}

double Lattice::bent(Size size, bool wraps_x, bool wraps_y, Size give) const {
  const auto along = [&](bool x) {
    const double missing = misfit(x ? size.width : size.height, x).length();
    return missing > 0 ? missing / (x ? give.width : give.height) : 0;
  };
  return std::max(wraps_x ? along(true) : 0, wraps_y ? along(false) : 0);
}

Size Lattice::best_fitting(Size size, bool wraps_x, bool wraps_y, Size give) const {
  if (rank == 0) return size;
  return {wraps_x ? best_side(*this, size.width, true, give.width) : size.width,
          wraps_y ? best_side(*this, size.height, false, give.height) : size.height};
}

LatticePhase::Matrix LatticePhase::to_cells(const Lattice& l, double scale) {
  const double ax = l.first.x * scale, ay = l.first.y * scale, bx = l.second.x * scale, by = l.second.y * scale;
  if (l.rank == 1) return ax != 0 ? Matrix{1 / ax, 0, 0, 0} : Matrix{0, 1 / ay, 0, 0};
  const double d = 1.0 / (ax * by - ay * bx);
  return {by * d, -bx * d, -ay * d, ax * d};
}

LatticePhase::LatticePhase(const Lattice& lattice, const Lattice& shown, const Vector2& start, int level,
                           const LatticeSurface& surface)
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
  const LatticeGaps& gaps = surface.gaps;
  const Size size = surface.size;
  const bool bends_x = surface.wraps_x && gaps.x.length > 0, bends_y = surface.wraps_y && gaps.y.length > 0;
  const Lattice fitted = shown.fitted(size, surface.wraps_x && !bends_x, surface.wraps_y && !bends_y);
  whole_ = lattice.is_whole() && fitted.is_whole() && !bends_x && !bends_y;
  shown_first_ = {fitted.first.x * scale, fitted.first.y * scale};
  shown_second_ = {fitted.second.x * scale, fitted.second.y * scale};
  to_output_ = to_cells(fitted, scale);
  const auto cells_of = [&](const Matrix& m, const Vector2& at) {
    return Vector2{(m.xx * at.x + m.xy * at.y) * scale, (m.yx * at.x + m.yy * at.y) * scale};
  };
  const Vector2 from = cells_of(to_exemplar_, start), to = cells_of(to_output_, surface.origin);
  origin_ = {to.x - from.x, to.y - from.y};
  if (bends_x || bends_y) {
    bent_x_ = bent(size.width, shown.misfit(size.width, true), level, bends_x ? gaps.x : LatticeGap{});
    bent_y_ = bent(size.height, shown.misfit(size.height, false), level, bends_y ? gaps.y : LatticeGap{});
  }
  if (active() && !resolves_cells_) find_promising_steps();
}

std::vector<Vector2> LatticePhase::bent(int length, const Vector2& misfit, int level, const LatticeGap& gap) const {
  const double scale = double(int64_t{1} << level);
  std::vector<Vector2> out(size_t(length / scale) + 2);
  if (gap.length <= 0) return out;
  const Vector2 missing{to_output_.xx * misfit.x / scale + to_output_.xy * misfit.y / scale,
                        to_output_.yx * misfit.x / scale + to_output_.yy * misfit.y / scale};
  for (size_t at = 0; at < out.size(); at++) {
    const double x = double(at) * scale;
    const double before = gap.begin + gap.length - length;  // the part of the gap that lies on the far side
    const double part = x < before       ? 1 - (x + length - gap.begin) / gap.length
                        : x >= gap.begin ? -std::min(1.0, (x - gap.begin) / gap.length)
                                         : 0;
    out[at] = {-missing.x * part, -missing.y * part};
  }
  return out;
}

/// How much the end of a step is out of phase, at least and at most, is known of all starts in a bin at once: it is
/// that of the bin's middle, give or take the bin's reach. What could be the cheapest is one step in most bins.
void LatticePhase::find_promising_steps() {
  const int rows = rank_ == 1 ? 1 : bins;
  constexpr double half = 0.5 / bins + 1e-6;  // beyond what rounding does to a start
  const double reach = half * (first_.length() + (rank_ == 1 ? 0 : second_.length()));
  promising_.resize(size_t(rows) * bins);
  for (int row = 0; row < rows; row++)
    for (int column = 0; column < bins; column++) {
      std::array<double, 64> least;
      least.fill(std::numeric_limits<double>::infinity());
      double limit = std::numeric_limits<double>::max();
      // Along courses every place is as good as the next.
      const int farthest_x = rank_ == 1 && first_.x == 0 ? 0 : farthest;
      const int farthest_y = rank_ == 1 && first_.x != 0 ? 0 : farthest;
      for (int dy = -farthest_y; dy <= farthest_y; dy++)
        for (int dx = -farthest_x; dx <= farthest_x; dx++) {
          const double i = (column + 0.5) / bins + to_exemplar_.xx * dx + to_exemplar_.xy * dy;
          const double j = rank_ == 1 ? 0 : (row + 0.5) / bins + to_exemplar_.yx * dx + to_exemplar_.yy * dy;
          const double p = i - nearest(i), q = j - nearest(j);
          double& lowest = least[bit_of(dx, dy)];
          double highest = 0;
          // Half-way between two cells a part of the bin counts from the one, a part from the other.
          for (const bool other_p : {false, true})
            for (const bool other_q : {false, true}) {
              if ((other_p && std::abs(p) + half < 0.5) || (other_q && std::abs(q) + half < 0.5)) continue;
              const double pp = other_p ? p - std::copysign(1, p) : p, qq = other_q ? q - std::copysign(1, q) : q;
              const double off = Vector2{first_.x * pp + second_.x * qq, first_.y * pp + second_.y * qq}.length();
              lowest = std::min(lowest, cost(penalty({std::max(0.0, off - reach), 0}), dx, dy));
              highest = std::max(highest, cost(penalty({off + reach, 0}), dx, dy));
            }
          limit = std::min(limit, highest);
        }
      for (int bit = 0; bit < int(least.size()); bit++)
        promising_[size_t(row) * bins + column] |= uint64_t{least[bit] <= limit} << bit;
    }
}

}  // namespace terrazzo
