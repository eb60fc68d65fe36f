#pragma once

#include <array>
#include <cstdint>

#include "core/base/geometry.h"

namespace terrazzo {

/// The surface that a triangle grid covers: an endless plane, or one that wraps.
struct GridSurface {
  Size size;  ///< pixels after which it wraps; of no meaning along an axis in which it does not
  bool wraps_x = false;
  bool wraps_y = false;
};

/// One of the three vertices around a pixel.
struct GridVertex {
  uint64_t bits = 0;  ///< random bits of the vertex
  int dx = 0;         ///< from the vertex to the pixel, in pixels: -reach..reach
  int dy = 0;
  double weight = 0;  ///< its blending weight; the squares of all three sum to 1
};

/// The triangle grid of Heitz & Neyret (High-performance by-example noise using a histogram-preserving blending
/// operator, 2018): rows of vertices, each shifted by half a cell against the one before. Every pixel lies in a
/// triangle of three vertices. Its barycentric coordinates, raised to a power (Deliot & Heitz, Procedural stochastic
/// textures by tiling and blending, 2019), are the blending weights; divided by the root of the sum of their squares
/// they keep the variance of independent samples.
///
/// A vertex depends on the seed and its place in the grid alone, so any part of the plane can be made by itself. A
/// surface that wraps holds a whole number of cells, and an even number of rows, none larger than asked for. Immutable;
/// thread-safe; the same on every machine.
class TriangleGrid {
 public:
  /// `cell`: the edge of a triangle, 1 pixel or more.
  TriangleGrid(int cell, const GridSurface& surface, uint64_t seed);

  /// For the pixel (x, y) of the plane, at most 2^40 pixels from its origin.
  std::array<GridVertex, 3> around(int64_t x, int64_t y) const;

  /// How far pixels are from vertices that count for them.
  int reach_x() const { return reach_x_; }
  int reach_y() const { return reach_y_; }

 private:
  /// A whole number of cells on a whole number of pixels.
  struct Axis {
    int64_t pixels = 1, cells = 1;
    bool wraps = false;
  };
  GridVertex vertex(int64_t column, int64_t row, int64_t x, int64_t y, double coordinate) const;

  Axis x_, y_;
  int reach_x_, reach_y_;
  uint64_t seed_;
};

}  // namespace terrazzo
