#pragma once

#include <cstddef>
#include <vector>

namespace terrazzo {

/// Where the boxes of a drawn graph go: in columns from left to right, every wire leading to the right.
struct BoxSize {
  double width = 0;
  double height = 0;
};

struct LayoutWire {
  size_t from = 0;    ///< a box before `to`
  double from_y = 0;  ///< where it leaves, from the top of the box
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
  /// For each wire its way: horizontal at every point, the first at its source and the last at its target. Between an
  /// odd point and the next one it crosses a column in a straight line.
  std::vector<std::vector<Point>> ways;
};

/// Columns by the longest way from a source; long wires pass between the boxes of the columns they cross; order within
/// a column by barycentres, heights by the least squared slope of wires (after Sugiyama, Tagawa & Toda 1981). Boxes
/// come in topological order.
Layout lay_out(const std::vector<BoxSize>& boxes, const std::vector<LayoutWire>& wires);

}  // namespace terrazzo
