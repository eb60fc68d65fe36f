#include "core/synthesis/state/plane_window.h"

#include <algorithm>

namespace terrazzo {

namespace {

struct Stretch {
  int first, length;
  bool closed;
};

Stretch around(int first, int length, int by, int all, bool tiles) {
  if (!tiles) {
    const int from = std::max(0, first - by);
    return {from, std::min(all, first + length + by) - from, false};
  }
  const int from = first - by, count = length + 2 * by;
  const bool crosses = from < 0 || from + count > all;
  // Sub-passes and levels alternate between even and odd positions, which breaks off at the border of an odd length.
  if (count >= all || (crosses && all % 2 != 0)) return {0, all, true};
  return {from, count, false};
}

}  // namespace

PlaneWindow PlaneWindow::all_of(const Plane& plane) {
  return {plane, whole(plane.size), plane.tile_x, plane.tile_y};
}

PlaneWindow PlaneWindow::around(const Rect& part, int by, const Plane& plane) {
  const Stretch x = terrazzo::around(part.x, part.width, by, plane.size.width, plane.tile_x);
  const Stretch y = terrazzo::around(part.y, part.height, by, plane.size.height, plane.tile_y);
  return {plane, {x.first, y.first, x.length, y.length}, x.closed, y.closed};
}

Rect PlaneWindow::held(const Rect& r) const {
  return {closed_x ? 0 : r.x - part.x, closed_y ? 0 : r.y - part.y, closed_x ? part.width : r.width,
          closed_y ? part.height : r.height};
}

}  // namespace terrazzo
