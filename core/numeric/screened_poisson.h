#pragma once

#include <cstddef>
#include <vector>

#include "core/base/task.h"

/// The screened Poisson equation on a grid of cells: in every cell, the sum over its neighbours of (v - v there) *
/// length of the common side / distance, plus v * (area * screen + hold), is the cell's force. The response to a single
/// force decays within about 1 / sqrt(screen). A large hold with a proportional force fixes a cell's value. Columns and
/// rows have individual widths and heights, so that grids of any size, wrapping or not, can be coarsened.
///
/// All arithmetic is in floats in a fixed order, and steps read only values of the previous step: results do not depend
/// on the number of threads or on the part of the grid that is computed.
namespace terrazzo {

/// Cells along one direction of a grid.
struct CellAxis {
  bool wraps = false;
  std::vector<float> widths;  ///< of the cells
  /// Between each cell and the one before, and behind the last: one over the distance of their centres, 0 if there is
  /// no other cell.
  std::vector<float> links;

  /// Cells of width 1.
  static CellAxis of_pixels(int count, bool wraps);
  /// Merges pairs of cells; a last cell may remain single.
  CellAxis coarser() const;
  int count() const { return int(widths.size()); }
};

/// The interpolation weights of a cell from the coarser axis: linear between centres, constant beyond the last centre
/// of an axis that does not wrap.
struct CoarseShare {
  int near = 0, far = 0;
  float far_share = 0;
};
std::vector<CoarseShare> coarse_shares(const CellAxis& fine, const CellAxis& coarse);

/// A row of cells and its neighbours.
struct CellRow {
  int count;
  const float *widths, *links;           ///< of the columns; as in CellAxis
  float height, link_above, link_below;  ///< of the row
  const float *above, *here, *below;     ///< values; also here[-1] and here[count]. Finite even where no link leads
  const float* forces;
  const float* holds;  ///< what a cell's value weighs in its equation beyond its area times screen
  float screen;
};
/// The residuals: the forces minus those that the values produce.
void residuals(const CellRow& row, float* out);
/// A relaxation step: moves each value by `step` times the change that solves its own equation.
void relaxed(const CellRow& row, float step, float* out);

/// Steps for consecutive calls of `relaxed` that best reduce the high frequencies, which coarser grids cannot
/// represent: those of the Chebyshev polynomial for eigenvalues from 1/2 to 2.
std::vector<float> smoothing_steps(int count);

/// Solves the equation by V-cycles of the multigrid method (Brandt 1977), in time proportional to the number of cells.
class ScreenedPoisson {
 public:
  ScreenedPoisson(CellAxis x, CellAxis y, double screen);

  /// Sets the holds of all cells, row by row; 0 by default. Call before `improve`.
  void hold(std::vector<float> holds);
  /// The forces of the current values, initially 0. Add the missing forces before calling `improve`.
  float* forces(int row);
  const float* values(int row) const { return levels_.front().row(row); }
  /// Moves the values, initially 0, towards the solution for the forces by one V-cycle; then sets the forces to those
  /// of the new values. Throws Cancelled.
  void improve(const Task& task);
  /// Frees everything but the values.
  void finish();

 private:
  struct Level {
    CellAxis x, y;
    std::vector<CoarseShare> x_shares, y_shares;  ///< of its cells in the next level
    std::vector<float> forces;
    std::vector<float> holds;   ///< of one row, if they are the same in all
    std::vector<float> values;  ///< rows with one more cell at either end
    size_t stride() const { return x.widths.size() + 2; }
    const float* row(int y) const { return &values[size_t(y) * stride() + 1]; }
    float* row(int y) { return &values[size_t(y) * stride() + 1]; }
    CellRow cells(int y, float screen) const;
    void close(float* row) const;
  };
  void smooth(Level& level, const Task& task) const;
  void smooth_once(Level& level, float step) const;
  void restrict_from(const Level& fine, Level& coarse) const;
  void prolong_to(Level& fine, const Level& coarse) const;
  void cycle(size_t level, const Task& task);

  float screen_;
  std::vector<float> steps_;
  std::vector<Level> levels_;
};

}  // namespace terrazzo
