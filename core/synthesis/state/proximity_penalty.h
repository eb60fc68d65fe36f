#pragma once

#include <cstdint>
#include <vector>

#include "core/synthesis/state/field.h"
#include "core/synthesis/state/plane_window.h"

namespace terrazzo {

/// The cells of an exemplar by which its use is counted: 16x16 of them, or fewer of at least 2x2 pixels.
struct ExemplarCells {
  explicit ExemplarCells(Size exemplar);
  size_t of(int x, int y) const { return row_starts[y] + columns[x]; }
  size_t of(const ExemplarPixel& p) const { return of(p.x, p.y); }

  size_t count = 0;
  std::vector<uint32_t> columns;     ///< of every x
  std::vector<uint32_t> row_starts;  ///< the first cell of every y's row of cells
};

/// How often every cell of the exemplar shows around every place of a plane, as a factor on the cost of showing it
/// there: above 1 where it shows more than once within half the exemplar's side or so, and more so within a third. Even
/// use of the exemplar says nothing about where: the same stones side by side are what the eye finds first. Any number
/// of threads may ask while none counts.
class ProximityPenalty {
 public:
  /// `areas`: how many pixels of each cell are usable; `weight`: what a doubled use adds to the cost.
  ProximityPenalty(Size exemplar, std::vector<double> areas, double weight, const Plane& plane);
  /// Whether that pays: in a plane of very many exemplars everything comes a thousand times, and to count it takes more
  /// memory than it is worth.
  static bool is_worth_it(Size exemplar, const ExemplarCells& cells, const Plane& plane);
  /// The field must hold the whole plane.
  void count(const Field& field, const ExemplarCells& cells);
  /// For showing each cell at a position of the plane, in 1/4096.
  const uint16_t* factors(int x, int y) const { return &factors_[block(x, y) * cells_]; }

 private:
  using Counts = std::vector<uint16_t>;  // of every block and cell
  /// Blocks one after the other, in x or in y.
  struct Line {
    int first;
    int step;
    int length;
    bool closed;
  };
  size_t block(int x, int y) const { return size_t(y / side_) * columns_ + x / side_; }
  void count_shown(const Field& field, const ExemplarCells& cells);
  void sum_along(const Line& line, int reach, const Counts& counts, Counts& sums) const;
  void sum_around(int reach);
  void raise_factors(int reach);

  Size exemplar_;
  std::vector<double> areas_;
  double weight_;
  Plane plane_;
  size_t cells_;
  int side_;  // of a block: what is near is told for all of its pixels alike
  int columns_, rows_;
  Counts shown_;          // by every block
  Counts across_, sums_;  // what blocks around it show: those beside it, and all
  Counts factors_;
};

}  // namespace terrazzo
