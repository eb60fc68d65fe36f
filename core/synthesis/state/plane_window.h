#pragma once

#include <cstdint>

#include "core/base/geometry.h"

namespace terrazzo {

/// The number nearest to 0 that is `v` around a circle of `length`.
inline int nearest_to_zero(int v, int length) {
  return wrap(v + length / 2, length) - length / 2;
}

/// Steps to the four neighbours of a pixel; side (s + 2) % 4 is opposite.
inline constexpr int sides[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};

/// The whole surface at one level of a synthesis, or the part of it that a field holds.
struct Plane {
  Size size;
  bool tile_x = false;  ///< it wraps around in x
  bool tile_y = false;  ///< and in y

  /// The index of (x, y) in values of every pixel, row by row. Beyond a border it wraps around, or it is -1.
  int64_t index(int x, int y) const {
    if (x < 0 || x >= size.width) {
      if (!tile_x) return -1;
      x = wrap(x, size.width);
    }
    if (y < 0 || y >= size.height) {
      if (!tile_y) return -1;
      y = wrap(y, size.height);
    }
    return int64_t{y} * size.width + x;
  }
  /// The same of a pixel's neighbour on that side.
  int64_t beside(int pixel, int side) const {
    return index(pixel % size.width + sides[side][0], pixel / size.width + sides[side][1]);
  }
};

/// Which part of a plane a field holds. Its columns and rows count from `part`'s corner.
struct PlaneWindow {
  Plane plane;
  Rect part;              ///< crosses a border only where the plane wraps
  bool closed_x = false;  ///< the part holds all of x and the plane wraps there, so that the field wraps as well
  bool closed_y = false;  ///< the same in y

  static PlaneWindow all_of(const Plane& plane);
  /// Holds `part` and up to `by` pixels around it, as far as the plane has them.
  static PlaneWindow around(const Rect& part, int by, const Plane& plane);

  Size size() const { return {part.width, part.height}; }
  /// The part as a plane of its own, whose positions are columns and rows.
  Plane field() const { return {size(), closed_x, closed_y}; }
  /// The position in the plane of a column and a row.
  int x(int column) const { return onto(part.x + column, plane.size.width); }
  int y(int row) const { return onto(part.y + row, plane.size.height); }
  /// The same as an index into values of the whole plane, row by row.
  size_t index(int column, int row) const { return size_t(y(row)) * plane.size.width + x(column); }
  /// The column and the row of a position that the part holds; where the field wraps, of any position.
  int column(int x) const { return closed_x ? wrap(x, part.width) : x - part.x; }
  int row(int y) const { return closed_y ? wrap(y, part.height) : y - part.y; }
  /// A rectangle of the plane as columns and rows; all of an axis that is closed.
  Rect held(const Rect& r) const;

 private:
  static int onto(int v, int length) { return v < 0 ? v + length : v >= length ? v - length : v; }
};

}  // namespace terrazzo
