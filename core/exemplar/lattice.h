#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/hash.h"
#include "core/numeric/eigen.h"

namespace terrazzo {

/// How an exemplar repeats. Rank 2: in two directions, by `first` and `second` (pixels of the finest level). Rank 1: in
/// bands across one axis only: courses (first = (0, height)) or columns (first = (width, 0)); along the bands anything
/// goes. Rank 0: it does not.
struct Lattice {
  int rank = 0;
  Vector2d first;
  Vector2d second;
  double certainty = 0;  ///< how much repeats exceed chance, 0..1

  /// A position in steps of the lattice, and back; of rank 1 along its one step only.
  Vector2d cells(const Vector2d& at) const;
  Vector2d at(const Vector2d& cells) const { return first * cells.x() + second * cells.y(); }
  /// Of a cell of rank 2, in square pixels.
  double cell_area() const { return std::abs(cross(first, second)); }
  /// Of rank 2: whether cells are whole pixels long and high.
  bool is_whole() const;
  /// Whether the vectors can carry a lattice of this rank.
  bool is_valid() const {
    if (rank == 1) return (first.x() == 0) != (first.y() == 0);
    return rank == 0 || (rank == 2 && cell_area() >= 1);
  }
  /// Its level courses, or its columns, as a lattice of rank 1: of rank 0 if it has none.
  Lattice level_bands(bool courses) const;
  /// The way that those run, which need not be quite level: the shortest step of the lattice along x, or along y, of
  /// any length if the rank is 1; (0, 0) if it has none.
  Vector2d along_bands(bool courses) const;
  /// Whether a band is as high, or as wide, as the exemplar. Of rank 1.
  bool comes_once(Size exemplar) const { return first.x() >= exemplar.width || first.y() >= exemplar.height; }
  /// Whether its cell is the whole exemplar.
  bool is_single_cell(Size exemplar) const { return rank == 2 && cell_area() > 0.99 * double(exemplar.area()); }
  /// The nearest lattice of which a surface of `size` holds a whole number of cells, along each axis in which it wraps.
  Lattice fitted(Size size, bool wraps_x, bool wraps_y) const;
  /// Whether a surface of `size` holds a whole number of cells along each axis in which it wraps, to `precision` pixels
  /// along it and across.
  bool fits(Size size, bool wraps_x, bool wraps_y, double precision = 1) const;

  /// By how many pixels a surface that wraps after `length` pixels along x or y misses a whole number of cells. Rank 1
  /// misses nothing along its bands.
  Vector2d misfit(int length, bool along_x) const;
  /// By how much, as a part of their length, cells must be bent within `give` pixels along each side for a surface of
  /// `size` to wrap: the more of the axes along which it does.
  double bent(Size size, bool wraps_x, bool wraps_y, Size give) const;
  /// Cells that are bent more do not hold together.
  static double most_bent();
  /// How much they can be bent without its being seen: the less sure the lattice, the more its cells vary anyway.
  double unseen_bend() const;
  bool operator==(const Lattice&) const = default;
  void add_to(Hasher& h) const {
    h.add(rank).add(first.x()).add(first.y()).add(second.x()).add(second.y()).add(certainty);
  }
};

/// All lattices of so many whole cells around an exemplar that tiles (Hermite normal form), of certainty 0.
std::vector<Lattice> lattices_around(Size exemplar, int cells);

/// Where along an axis in which a surface wraps around a lattice bends until the surface holds a whole number of cells:
/// `length` pixels of the finest level from `begin` on, around the border. Elsewhere it stays as it is.
struct LatticeGap {
  double begin = 0;
  double length = 0;  ///< 0: it does not bend
};
struct LatticeGaps {
  LatticeGap x, y;
};

/// Part of an exemplar along one axis, in pixels; may go on around the border of one that tiles.
struct ExemplarSpan {
  double from, to;
  double length() const { return to - from; }
  bool operator==(const ExemplarSpan&) const = default;
};
/// Which one a surface shows from one place to another, in pixels of the finest level. Its ends are shown where they
/// are: what is too much is left out at `cut`, what is missing is repeated there. Half a pixel at each end is not
/// seen.
struct ShownSpan {
  double begin, end;  ///< of the surface
  int number;         ///< among the exemplar's
  ExemplarSpan shown;
  double cut;  ///< of the surface

  double too_much() const { return shown.length() - (end - begin); }
  bool is_cut() const { return std::abs(too_much()) > 1; }
  /// From a place on the surface to what it shows of the exemplar, in whole pixels.
  int shift(double place) const {
    const double by = !is_cut()     ? shown.from - begin + too_much() / 2
                      : place < cut ? shown.from - begin
                                    : shown.to - end;
    return int(std::floor(by + 0.5));
  }
};

/// The result that a lattice is shown on, in pixels of its finest level.
struct LatticeSurface {
  Size size;
  bool wraps_x = false;
  bool wraps_y = false;
  Vector2d origin{};   ///< the position at which the exemplar's start is in phase
  LatticeGaps gaps{};  ///< along which of the axes in which it wraps the lattice is bent, and where
  /// If it shows the bands of one repeat in an order of their own: those, in that order, instead of all the above.
  std::vector<ShownSpan> bands{};
};

/// Tells whether exemplar positions are in phase with output positions, at the scale of one pyramid level: whether both
/// lie at the same place within the lattice's cell. Basic arithmetic only, so every machine decides alike.
class LatticePhase {
 public:
  LatticePhase() = default;
  /// `level`: 0 = the finest. A result that wraps around must hold a whole number of cells: unless it has gaps to bend
  /// in, its lattice is stretched until it does. Inactive where a pixel has become larger than two cells.
  LatticePhase(const Lattice& lattice, int level, const LatticeSurface& surface)
      : LatticePhase(lattice, lattice, {}, level, surface) {}
  /// A cell of `lattice` is shown as one of `shown`, which has the same rank. `start`: the exemplar position, at the
  /// finest level, that is in phase with the surface's origin.
  LatticePhase(const Lattice& lattice, const Lattice& shown, const Vector2d& start, int level,
               const LatticeSurface& surface);

  bool active() const { return rank_ > 0; }
  /// Whether a cell is large enough to tell places within it apart. Where it is not, positions can still be in phase:
  /// two that are a whole number of cells apart at the finest level.
  bool resolves_cells() const { return resolves_cells_; }

  /// Whether cells are whole pixels of the finest level long and high, both in the exemplar and as they are shown, as
  /// in drawn patterns: what is in phase there is so to the pixel.
  bool is_whole() const { return whole_; }

  /// What the exemplar position (u, v) has too much to be in phase with the output position (x, y), in pixels.
  [[gnu::always_inline]] Vector2d excess(int u, int v, double x, double y) const {
    const Vector2d c = cells(u, v, x, y);
    return first_ * (c.x() - nearest(c.x())) + second_ * (c.y() - nearest(c.y()));
  }

  /// Moves (u, v) into phase with (x, y); where cells are not resolved, to the position in reach that is nearest to it.
  [[gnu::always_inline]] void snap(double x, double y, int& u, int& v) const {
    if (!active()) return;
    if (!resolves_cells_) {
      search(x, y, u, v);
      return;
    }
    const Vector2d e = excess(u, v, x, y);
    u -= int(nearest(e.x()));
    v -= int(nearest(e.y()));
  }

  /// Factor on the cost of a candidate that is further out of phase than the lattice's certainty leaves open.
  [[gnu::always_inline]] double penalty(int u, int v, double x, double y) const { return penalty(excess(u, v, x, y)); }

  /// One of the result's positions that are in phase with the exemplar position (u, v). Only where nothing bends.
  Vector2d shown_at(int u, int v) const {
    const Vector2d c = cells(u, v, 0, 0);
    return shown_first_ * c.x() + shown_second_ * c.y();
  }

 private:
  static Matrix2d to_cells(const Lattice& lattice, double scale);
  [[gnu::always_inline]] static double nearest(double v) { return std::floor(v + 0.5); }
  [[gnu::always_inline]] double penalty(const Vector2d& excess) const {
    const double misfit = excess.squaredNorm() * stiffness_;
    return misfit <= 1 ? 1.0 : 1.0 + misfit;
  }

  /// By how many cells, in each direction, the exemplar position (u, v) is too far on for the output position (x, y).
  [[gnu::always_inline]] Vector2d cells(int u, int v, double x, double y) const {
    Vector2d straight = to_exemplar_.col(0) * double(u) + to_exemplar_.col(1) * double(v) - to_output_.col(0) * x -
                        to_output_.col(1) * y + origin_;
    if (bent_x_.empty()) return straight;
    return straight + bent_x_[size_t(x)] + bent_y_[size_t(y)];
  }
  /// What bending adds to cells() at each of the level's pixels along x or y, an axis of `length` pixels of the finest
  /// level on which the lattice misses whole cells by `misfit`.
  std::vector<Vector2d> bent(int length, const Vector2d& misfit, int level, const LatticeGap& gap) const;
  /// The same for bands in an order of their own. `step`: the lattice's, in pixels of the finest level.
  std::vector<Vector2d> bent_to(const std::vector<ShownSpan>& bands, int length, double step, int level) const;
  /// What it costs to take a step: of several positions in phase the nearest is the best.
  [[gnu::always_inline]] static double cost(double penalty, int dx, int dy) {
    return penalty + 0.001 * (dx * dx + dy * dy);
  }

  // A step's bit: the rows of a square, each in a byte.
  static constexpr int farthest = 3;
  static constexpr int bit_of(int dx, int dy) { return (dy + farthest) * 8 + dx + farthest; }
  static constexpr int step_x(int bit) { return bit % 8 - farthest; }
  static constexpr int step_y(int bit) { return bit / 8 - farthest; }

  static constexpr int bins = 64;
  [[gnu::always_inline]] static int bin_of(double cells) {
    return std::min(bins - 1, int((cells - std::floor(cells)) * bins));
  }

  /// Takes the cheapest of the steps to pixels up to `farthest` away along each axis.
  [[gnu::always_inline]] void search(double x, double y, int& u, int& v) const {
    const Vector2d place = cells(u, v, x, y);
    uint64_t left = promising_[size_t(bin_of(place.x()) + (rank_ == 1 ? 0 : bin_of(place.y()) * bins))];
    int best = std::countr_zero(left);
    if (!std::has_single_bit(left)) {
      double least = std::numeric_limits<double>::max();
      for (; left != 0; left &= left - 1) {
        const int bit = std::countr_zero(left), dx = step_x(bit), dy = step_y(bit);
        const double c = cost(penalty(u + dx, v + dy, x, y), dx, dy);
        best = c < least ? bit : best;
        least = std::min(least, c);
      }
    }
    u += step_x(best);
    v += step_y(best);
  }
  void find_promising_steps();

  bool resolves_cells_ = false;
  bool whole_ = false;
  double stiffness_ = 1;  // 1 / the square of what a position may be out of phase, in pixels
  int rank_ = 0;
  Vector2d first_, second_;              // in pixels of the level
  Vector2d shown_first_, shown_second_;  // likewise, as they are shown
  Matrix2d to_exemplar_;                 // pixels to cells; for rank 1 its second row is 0
  Matrix2d to_output_;
  Vector2d origin_;                        // of the output less the exemplar's start, in cells
  std::vector<Vector2d> bent_x_, bent_y_;  // both empty where nothing bends
  // Where cells are not resolved, which steps may be the cheapest, by where in a cell they start: `bins` to a row.
  std::vector<uint64_t> promising_;
};

}  // namespace terrazzo
