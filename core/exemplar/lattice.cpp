#include "core/exemplar/lattice.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/base/tuning.h"

namespace terrazzo {

namespace {

struct LatticeTuning {
  double smallest_resolved = 3;
  double smallest_cell = 0.5;
  double looseness = 1.0 / 12;
  double certainty_counts = 2.0 / 3;
  double most_slanted = 0.02;
  double most_bent = 0.15;
  double unseen_bend = 0.01;
  double unseen_bend_by_doubt = 0.025;
  int farthest = 3;
};
const Tunable<LatticeTuning> lattice_tuning(
    "lattice",
    {
        {&LatticeTuning::smallest_resolved, "smallest_resolved", "pixels of the level",
         "from which on a cell is large enough to tell places within it apart. Higher: more levels only keep to whole "
         "cells; lower: cells of few pixels decide what fits",
         "k_coherence"},
        {&LatticeTuning::smallest_cell, "smallest_cell", "pixels of the level",
         "finer cells have no say: finer levels bring pieces into place. Higher: cells are broken up at coarse levels; "
         "lower: so few places are in phase that the same rows come back all over a large surface",
         "regularity"},
        {&LatticeTuning::looseness, "looseness", "cells",
         "how far out of phase a position may be. Higher: less is copied verbatim; lower: less is broken",
         "regularity"},
        {&LatticeTuning::certainty_counts, "certainty_counts", "share",
         "of the looseness that a certain lattice takes away: the surer it is, the less its cells differ. Higher: sure "
         "lattices are kept to; lower: pieces fit better",
         "k_coherence", 0, 1},
        {&LatticeTuning::most_slanted, "most_slanted", "share of their length",
         "by which level courses rise. Higher: walls that were not scanned level have courses; lower: patterns aslant "
         "have none",
         "What each rule decides"},
        {&LatticeTuning::most_bent, "most_bent", "share of a cell",
         "higher: more sizes wrap; lower: cells hold together", "What each rule decides"},
        {&LatticeTuning::unseen_bend, "unseen_bend", "share of a cell",
         "that a certain lattice can be bent by without its being seen. Higher: sizes that do not quite fit are taken "
         "without a word; lower: they are changed, or warned of",
         "What each rule decides"},
        {&LatticeTuning::unseen_bend_by_doubt, "unseen_bend_by_doubt", "share of a cell",
         "the same, in addition, of one that is not certain at all, whose cells vary anyway", "What each rule decides"},
        {&LatticeTuning::farthest, "farthest", "steps along both vectors",
         "in which a course may run. Higher: bonds of many bricks have courses, too; lower: less chance",
         "What each rule decides", 1, 1000},
    });

/// Of the matrix that has these two columns.
Matrix2d inverse(const Vector2d& a, const Vector2d& b) {
  const double d = 1.0 / cross(a, b);
  Matrix2d out;
  out << b.y() * d, -b.x() * d, -a.y() * d, a.x() * d;
  return out;
}

}  // namespace

double Lattice::most_bent() {
  return lattice_tuning->most_bent;
}

double Lattice::unseen_bend() const {
  return lattice_tuning->unseen_bend + lattice_tuning->unseen_bend_by_doubt * (1 - certainty);
}

bool Lattice::is_whole() const {
  constexpr double rounding = 1e-6;
  const auto whole = [](double v) { return std::abs(v - std::floor(v + 0.5)) < rounding; };
  return rank == 2 && whole(first.x()) && whole(first.y()) && whole(second.x()) && whole(second.y());
}

Vector2d Lattice::along_bands(bool courses) const {
  if (rank == 1) return (first.x() == 0) == courses ? courses ? Vector2d{1, 0} : Vector2d{0, 1} : Vector2d{};
  if (rank == 0) return {};
  const int farthest = lattice_tuning->farthest;
  const double most_slanted = lattice_tuning->most_slanted;
  Vector2d shortest;
  for (int i = -farthest; i <= farthest; i++)
    for (int j = -farthest; j <= farthest; j++) {
      const Vector2d v = at({double(i), double(j)});
      const double along = courses ? v.x() : v.y(), across = std::abs(courses ? v.y() : v.x());
      const double least = courses ? shortest.x() : shortest.y();
      if (along > 0 && across <= most_slanted * along && (least == 0 || along < least)) shortest = v;
    }
  return shortest;
}

Lattice Lattice::level_bands(bool courses) const {
  if (rank == 1) return (first.x() == 0) == courses ? *this : Lattice{};
  const Vector2d along = along_bands(courses);
  const double length = courses ? along.x() : along.y();
  if (length == 0) return {};
  const double period = cell_area() / length;
  return {1, courses ? Vector2d{0, period} : Vector2d{period, 0}, {}, certainty};
}

Lattice Lattice::fitted(Size size, bool wraps_x, bool wraps_y) const {
  const auto whole = [](double cells, bool wraps) { return wraps ? std::floor(cells + 0.5) : cells; };
  const double w = size.width, h = size.height;
  Lattice out = *this;
  if (rank == 1) {
    const int axis = first.x() != 0 ? 0 : 1;
    const double length = axis == 0 ? w : h, cells = whole(length / first[axis], axis == 0 ? wraps_x : wraps_y);
    if (std::abs(cells) >= 1) out.first[axis] = length / cells;
  }
  if (rank == 2) {
    // Column by column, the cells that the surface spans along x and along y; its inverse gives the vectors.
    const Matrix2d to_cells = inverse(first, second);
    const double ix = whole(to_cells(0, 0) * w, wraps_x), jx = whole(to_cells(1, 0) * w, wraps_x);
    const double iy = whole(to_cells(0, 1) * h, wraps_y), jy = whole(to_cells(1, 1) * h, wraps_y);
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
    return misfit(length, along_x).lpNorm<Eigen::Infinity>() <= precision;
  };
  return (!wraps_x || comes_back(size.width, true)) && (!wraps_y || comes_back(size.height, false));
}

Vector2d Lattice::cells(const Vector2d& at) const {
  if (rank == 1) return {first.x() != 0 ? at.x() / first.x() : at.y() / first.y(), 0};
  return Vector2d{cross(at, second), cross(first, at)} * (1.0 / cross(first, second));
}

Vector2d Lattice::misfit(int length, bool along_x) const {
  if (rank == 0) return {};
  const auto part = [](double cells) { return cells - std::floor(cells + 0.5); };
  const Vector2d c = cells(along_x ? Vector2d{double(length), 0} : Vector2d{0, double(length)});
  const double i = part(c.x()), j = part(c.y());
  if (rank == 1) return at({i, 0});
  // In a skewed cell the nearest corner need not be the one that both parts round to.
  Vector2d least{};
  double shortest = std::numeric_limits<double>::max();
  for (const double p : {i, i - std::copysign(1, i)})
    for (const double q : {j, j - std::copysign(1, j)}) {
      const Vector2d v = at({p, q});
      if (v.norm() >= shortest) continue;
      shortest = v.norm();
      least = v;
    }
  return least;
}

double Lattice::bent(Size size, bool wraps_x, bool wraps_y, Size give) const {
  const auto along = [&](bool x) {
    const double missing = misfit(x ? size.width : size.height, x).norm();
    return missing > 0 ? missing / (x ? give.width : give.height) : 0;
  };
  return std::max(wraps_x ? along(true) : 0, wraps_y ? along(false) : 0);
}

Matrix2d LatticePhase::to_cells(const Lattice& l, double scale) {
  const Vector2d a = l.first * scale, b = l.second * scale;
  if (l.rank == 2) return inverse(a, b);
  const int axis = a.x() != 0 ? 0 : 1;
  Matrix2d out = Matrix2d::Zero();
  out(0, axis) = 1 / a[axis];
  return out;
}

LatticePhase::LatticePhase(const Lattice& lattice, const Lattice& shown, const Vector2d& start, int level,
                           const LatticeSurface& surface)
    : rank_(lattice.rank) {
  if (rank_ == 0) return;
  const double scale = 1.0 / double(int64_t{1} << level);
  first_ = lattice.first * scale;
  second_ = lattice.second * scale;
  const double cell = rank_ == 1 ? std::abs(first_.sum()) : std::sqrt(std::abs(cross(first_, second_)));
  resolves_cells_ = cell >= lattice_tuning->smallest_resolved;
  if (cell < lattice_tuning->smallest_cell) rank_ = 0;
  const double loose = cell * lattice_tuning->looseness * (1 - lattice.certainty * lattice_tuning->certainty_counts);
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
  shown_first_ = fitted.first * scale;
  shown_second_ = fitted.second * scale;
  to_output_ = to_cells(fitted, scale);
  origin_ = to_output_ * surface.origin * scale - to_exemplar_ * start * scale;
  if (bends_x || bends_y) {
    bent_x_ = bent(size.width, shown.misfit(size.width, true), level, bends_x ? gaps.x : LatticeGap{});
    bent_y_ = bent(size.height, shown.misfit(size.height, false), level, bends_y ? gaps.y : LatticeGap{});
  }
  if (!surface.bands.empty()) {
    const bool columns = lattice.first.x() != 0;
    bent_x_ = bent_to(columns ? surface.bands : std::vector<ShownSpan>(), size.width, lattice.first.x(), level);
    bent_y_ = bent_to(columns ? std::vector<ShownSpan>() : surface.bands, size.height, lattice.first.y(), level);
  }
  if (active() && !resolves_cells_) find_promising_steps();
}

std::vector<Vector2d> LatticePhase::bent_to(const std::vector<ShownSpan>& bands, int length, double step,
                                            int level) const {
  const double scale = double(int64_t{1} << level);
  std::vector<Vector2d> out(size_t(length / scale) + 2);
  for (size_t i = 0; i < out.size() && !bands.empty(); i++) {
    double at = double(i) * scale;
    if (at < bands.front().begin) at += bands.back().end - bands.front().begin;
    const ShownSpan& b = *(std::ranges::upper_bound(bands, at, {}, &ShownSpan::begin) - 1);
    out[i].x() = to_output_.row(0).sum() * double(i) - origin_.x() - (at + b.shift(at)) / step;
  }
  return out;
}

std::vector<Vector2d> LatticePhase::bent(int length, const Vector2d& misfit, int level, const LatticeGap& gap) const {
  const double scale = double(int64_t{1} << level);
  std::vector<Vector2d> out(size_t(length / scale) + 2);
  if (gap.length <= 0) return out;
  const Vector2d missing = to_output_ * misfit / scale;
  for (size_t at = 0; at < out.size(); at++) {
    const double x = double(at) * scale;
    const double before = gap.begin + gap.length - length;  // the part of the gap that lies on the far side
    const double part = x < before       ? 1 - (x + length - gap.begin) / gap.length
                        : x >= gap.begin ? -std::min(1.0, (x - gap.begin) / gap.length)
                                         : 0;
    out[at] = -missing * part;
  }
  return out;
}

/// How much the end of a step is out of phase, at least and at most, is known of all starts in a bin at once: it is
/// that of the bin's middle, give or take the bin's reach. What could be the cheapest is one step in most bins.
void LatticePhase::find_promising_steps() {
  const int rows = rank_ == 1 ? 1 : bins;
  constexpr double half = 0.5 / bins + 1e-6;  // beyond what rounding does to a start
  const double reach = half * (first_.norm() + (rank_ == 1 ? 0 : second_.norm()));
  promising_.resize(size_t(rows) * bins);
  for (int row = 0; row < rows; row++)
    for (int column = 0; column < bins; column++) {
      std::array<double, 64> least;
      least.fill(std::numeric_limits<double>::infinity());
      double limit = std::numeric_limits<double>::max();
      // Along courses every place is as good as the next.
      const int farthest_x = rank_ == 1 && first_.x() == 0 ? 0 : farthest;
      const int farthest_y = rank_ == 1 && first_.x() != 0 ? 0 : farthest;
      for (int dy = -farthest_y; dy <= farthest_y; dy++)
        for (int dx = -farthest_x; dx <= farthest_x; dx++) {
          const double i = (column + 0.5) / bins + to_exemplar_(0, 0) * dx + to_exemplar_(0, 1) * dy;
          const double j = rank_ == 1 ? 0 : (row + 0.5) / bins + to_exemplar_(1, 0) * dx + to_exemplar_(1, 1) * dy;
          const double p = i - nearest(i), q = j - nearest(j);
          double& lowest = least[bit_of(dx, dy)];
          double highest = 0;
          // Half-way between two cells a part of the bin counts from the one, a part from the other.
          for (const bool other_p : {false, true})
            for (const bool other_q : {false, true}) {
              if ((other_p && std::abs(p) + half < 0.5) || (other_q && std::abs(q) + half < 0.5)) continue;
              const double pp = other_p ? p - std::copysign(1, p) : p, qq = other_q ? q - std::copysign(1, q) : q;
              const double off = (first_ * pp + second_ * qq).norm();
              lowest = std::min(lowest, cost(penalty(Vector2d{std::max(0.0, off - reach), 0}), dx, dy));
              highest = std::max(highest, cost(penalty(Vector2d{off + reach, 0}), dx, dy));
            }
          limit = std::min(limit, highest);
        }
      for (int bit = 0; bit < int(least.size()); bit++)
        promising_[size_t(row) * bins + column] |= uint64_t{least[bit] <= limit} << bit;
    }
}

std::vector<Lattice> lattices_around(Size exemplar, int cells) {
  std::vector<Lattice> out;
  for (int across = 1; across <= cells; across++) {
    if (cells % across != 0) continue;
    const int down = cells / across;
    const double width = double(exemplar.width) / across, height = double(exemplar.height) / down;
    // Of whole shifts by the exemplar's width over all cells there are as many as rows.
    for (int shift = 0; shift < down; shift++) out.push_back({2, {width, 0}, {width * shift / down, height}, 0});
  }
  return out;
}

}  // namespace terrazzo
