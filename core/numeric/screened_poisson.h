#pragma once

#include <cstddef>
#include <vector>

#include "core/base/task.h"

/// The screened Poisson equation on a grid of cells: in every cell, the sum over its neighbours of (v - v there) *
/// length of the common side / distance, plus v * (area * screen + hold), is the cell's force. A single force fades out
/// within about 1 / sqrt(screen); a large hold with a force as much larger gives a cell its value. Cells are as wide as
/// their column and as high as their row says, so that grids of any size, wrapping or not, have a coarser one.
///
/// All arithmetic is in floats in a fixed order, and no cell sees what the same step made of another: the same bits
/// with any number of threads, and whatever part of a grid is looked at.
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
  /// Every two cells as one; the last may be one alone.
  CellAxis coarser() const;
  int count() const { return int(widths.size()); }
};

/// How a cell's value is interpolated from those of the coarser axis: linearly between centres, constant beyond the
/// last one of an axis that does not wrap.
struct CoarseShare {
  int near = 0, far = 0;
  float far_share = 0;
};
std::vector<CoarseShare> coarse_shares(const CellAxis& fine, const CellAxis& coarse);

/// A row of cells and its surroundings.
struct CellRow {
  int count;
  const float *widths, *links;           ///< of the columns; as in CellAxis
  float height, link_above, link_below;  ///< of the row
  const float *above, *here, *below;     ///< values; also here[-1] and here[count]. Finite even where no link leads
  const float* forces;
  const float* holds;  ///< what a cell's value weighs in its equation beyond its area times screen
  float screen;
};
/// What the cells' forces are beyond those that would give them their values.
void residuals(const CellRow& row, float* out);
/// Each value moved by `step` times what would make its own equation true.
void relaxed(const CellRow& row, float step, float* out);

/// Steps for `relaxed`, one after the other, that reduce most what coarser grids cannot show: those of the Chebyshev
/// polynomial over the eigenvalues from 1/2 to 2.
std::vector<float> smoothing_steps(int count);

/// Solves the equation by V-cycles of the multigrid method (Brandt 1977), in time proportional to the number of cells.
class ScreenedPoisson {
 public:
  ScreenedPoisson(CellAxis x, CellAxis y, double screen);

  /// Holds cells, by so much each, row by row; none if it is not called. To be called before `improve`.
  void hold(std::vector<float> holds);
  /// The forces that the values have, 0 at first. Whoever adds to them what they lack has them made good by `improve`.
  float* forces(int row);
  const float* values(int row) const { return levels_.front().row(row); }
  /// One V-cycle brings the values, 0 at first, nearer to those of the forces; these then become what the values have.
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
