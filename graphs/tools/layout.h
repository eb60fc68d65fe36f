#pragma once

#include <cstddef>
#include <vector>

namespace terrazzo {

/// Places the boxes of a drawn graph in columns such that every wire leads to the right.
struct BoxSize {
  double width = 0;
  double height = 0;
};

struct LayoutWire {
  size_t from = 0;    ///< a box before `to`
  double from_y = 0;  ///< its start, measured from the top of the box
  size_t to = 0;
  double to_y = 0;
};

struct Point {
  double x = 0;
  double y = 0;
};

struct Layout {
  double width = 0;
  double height = 0;
  std::vector<Point> corners;  ///< top left corner of each box
  /// The path of each wire from source to target; it is horizontal at every point. Between an odd point and the next it
  /// crosses a column in a straight line.
  std::vector<std::vector<Point>> ways;
};

/// Assigns columns by the longest path from a source, orders boxes within a column by barycentres, and sets their
/// heights by least squares of the wires' slopes (after Sugiyama, Tagawa & Toda 1981). Long wires pass between the
/// boxes of the columns they cross. Boxes must be in topological order.
Layout lay_out(const std::vector<BoxSize>& boxes, const std::vector<LayoutWire>& wires);

}  // namespace terrazzo
