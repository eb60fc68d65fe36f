#pragma once

#include "core/base/geometry.h"

namespace terrazzo {

/// The whole surface at one level of a synthesis.
struct Plane {
  Size size;
  bool tile_x = false;  ///< it wraps around in x
  bool tile_y = false;  ///< and in y
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
