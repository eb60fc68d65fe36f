#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/synthesis/state/field.h"
#include "core/synthesis/state/plane_window.h"

namespace terrazzo {

/// The cells of an exemplar by which its use is counted: 16 along its longer side, or fewer of at least 2x2 pixels.
struct ExemplarCells {
  explicit ExemplarCells(Size exemplar);
  size_t of(int x, int y) const { return row_starts[y] + columns[x]; }
  size_t of(const ExemplarPixel& p) const { return of(p.x, p.y); }

  size_t count = 0;
  std::vector<uint32_t> columns;     ///< of every x
  std::vector<uint32_t> row_starts;  ///< the first cell of every y's row of cells
};

/// A factor on the cost of showing each cell of the exemplar at each place of a plane: above 1 where the cell shows
/// more than once near by. UsagePenalty evens out how often cells show, but not where: the same stones side by side are
/// what the eye finds first. Any number of threads may read while none counts.
class ProximityPenalty {
 public:
  /// `areas`: how many pixels of each cell are usable; `weight`: what showing a cell twice near by adds to its cost.
  ProximityPenalty(Size exemplar, std::vector<double> areas, double weight, const Plane& plane);
  /// Whether counting pays: in a plane of very many exemplars everything repeats a thousand times, and the counts take
  /// more memory than they are worth.
  static bool is_worth_it(Size exemplar, const ExemplarCells& cells, const Plane& plane);
  /// The field must hold the whole plane.
  void count(const Field& field, const ExemplarCells& cells);
  /// The factors of all cells at a position of the plane, in unit_factor.
  const uint16_t* factors(int x, int y) const { return &factors_[block(x, y) * cells_]; }

 private:
  using Counts = std::vector<uint16_t>;  // of every block and cell
  /// A row or a column of blocks.
  struct Line {
    int first;
    int step;
    int length;
    bool closed;
  };
  size_t block(int x, int y) const { return size_t(y / side_) * columns_ + x / side_; }
  class LineSums;
  void count_shown(const Field& field, const ExemplarCells& cells);
  void sum_rows();
  void raise_factors();
  /// What each pixel of a cell adds to its factor within a reach.
  std::vector<float> weights(int reach) const;

  Size exemplar_;
  std::vector<double> areas_;
  double weight_;
  Plane plane_;
  size_t cells_;
  int side_;  // of a block: its pixels share their counts
  int columns_, rows_;
  Counts shown_;                    // pixels of each cell in every block
  std::array<Counts, 2> row_sums_;  // their sums over neighbouring blocks of the row: of the far and the near reach
  Counts factors_;
};

}  // namespace terrazzo
