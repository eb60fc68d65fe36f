#pragma once

#include <vector>

#include "core/procedural/stone_packing.h"

namespace terrazzo {

/// Slabs broken out of larger ones: the cells of a packing, each cut by straight lines until its parts are small
/// enough. Parts are convex, and cuts end at other cuts like cracks. Immutable.
class SlabCuts {
 public:
  /// `unit`: the mean size of a slab in units of the canvas; `uneven` in [0, 1]: the variation of slab sizes.
  SlabCuts(const Canvas& canvas, double unit, double uneven, uint64_t salt);

  struct Place {
    uint64_t id;
    double x, y;      ///< from the slab's middle
    double distance;  ///< to its border
  };
  Place at(double u, double v) const;

  /// A polygon's corners, in order, from the site of its cell.
  struct Corner {
    double x, y;
  };
  using Polygon = std::vector<Corner>;

 private:
  /// The points where nx x + ny y < c lie before the line; (nx, ny) has length 1.
  struct Line {
    double nx, ny, c;
  };
  struct Slab {
    uint64_t id;
    Corner middle;
    std::vector<Line> edges;
  };
  /// A cut with what lies before and behind it; a slab where `slab` is not negative.
  struct Part {
    Line line{};
    int before = 0, behind = 0;
    int slab = -1;
  };

  Polygon cell_around(const StonePacking::Stone& stone) const;
  int cut(const Polygon& polygon, Dice& dice);
  Line crack(const Polygon& polygon, Dice& dice) const;
  int add_slab(const Polygon& polygon);
  static Polygon before(const Polygon& polygon, const Line& line);

  double unit_;
  double uneven_;
  StonePacking cells_;
  std::vector<int> roots_;  ///< the first part of each cell, by its id
  std::vector<Part> parts_;
  std::vector<Slab> slabs_;
};

}  // namespace terrazzo
