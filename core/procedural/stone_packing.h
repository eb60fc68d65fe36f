#pragma once

#include <vector>

#include "core/procedural/surface.h"

namespace terrazzo {

/// Sizes of packed stones: about one of mean size per square of side `unit`, in units of the canvas.
struct PackingSpec {
  double unit = 0.2;
  std::vector<double> radii;  ///< of the discs that the stones grow around, large to small, in units
  uint64_t salt = 1;
};

/// Stones of several sizes that fill the canvas: the power diagram of discs thrown until no more fit, the large ones
/// first (Aurenhammer, Power diagrams, 1987), so that small stones fill the gaps between large ones. Cells are convex.
/// Immutable.
class StonePacking {
 public:
  StonePacking(const Canvas& canvas, const PackingSpec& spec);

  struct Stone {
    double x, y, radius;
    uint64_t id;  ///< counts from 0; the same for the copies of a stone on a wrapping canvas
  };
  /// The position of a point on its stone.
  struct Place {
    uint64_t id;
    double x, y;      ///< from the stone's disc
    double distance;  ///< to the border of the cell, its corners rounded
  };
  Place at(double u, double v) const;
  const Stone& owner(double u, double v) const;
  /// Calls `visit(stone)` for all stones that may touch the cell at the point, the cell's own included.
  template <typename Visit>
  void visit_near(double u, double v, const Visit& visit) const {
    const int64_t column = bucket(u), row = bucket(v);
    for (int64_t j = std::max<int64_t>(row - 1, 0); j <= std::min<int64_t>(row + 1, rows_ - 1); j++)
      for (int64_t i = std::max<int64_t>(column - 1, 0); i <= std::min<int64_t>(column + 1, columns_ - 1); i++)
        for (const Stone& stone : buckets_[size_t(j * columns_ + i)]) visit(stone);
  }

  /// All stones, without copies, in the order of their ids.
  const std::vector<Stone>& stones() const { return stones_; }

 private:
  int64_t bucket(double along) const;
  void throw_discs(const Canvas& canvas, const PackingSpec& spec, double radius, uint64_t salt);
  bool fits(double x, double y, double radius) const;
  void add_copies(const Canvas& canvas, const Stone& stone);

  double unit_;
  double bucket_size_;
  double margin_;  ///< how far stones extend beyond the canvas
  int64_t columns_, rows_;
  std::vector<std::vector<Stone>> buckets_;
  std::vector<Stone> stones_;
};

}  // namespace terrazzo
