#include "core/synthesis/steps/element_warp.h"

#include <cmath>

#include <doctest/doctest.h>

#include "core/base/task.h"

using namespace terrazzo;

namespace {

const Task task;
constexpr int side = 40;  // of each of four by four square stones

Elements squares() {
  Elements out;
  out.size = {4 * side, 4 * side};
  out.count = 16;
  out.certainty = 1;
  for (int y = 0; y < out.size.height; y++)
    for (int x = 0; x < out.size.width; x++) out.at.push_back(uint16_t(y / side * 4 + x / side));
  return out;
}

/// Two stones side by side in a result that just holds them, `apart` blocks from centre to centre.
ElementPacking two_stones(const ElementShapes& shapes, int apart) {
  ElementPacking packing(shapes, {{side + apart, side}});
  std::vector<PlacedElement> placed;
  for (const int i : {0, 1}) {
    PlacedElement p{i};
    p.shift_x = shapes[i].centre_x - (side / 2 + i * apart);
    p.shift_y = shapes[i].centre_y - side / 2;
    p.stays = true;
    placed.push_back(p);
  }
  packing.pack(placed, task);
  return packing;
}

}  // namespace

TEST_CASE("stones that overlap, or leave a gap, are squeezed or stretched until their outlines meet") {
  const Elements elements = squares();
  const ElementShapes shapes = element_shapes(elements, {}, 1, true);
  for (const int apart : {side - 10, side + 8}) {
    CAPTURE(apart);
    const ElementPacking packing = two_stones(shapes, apart);
    const ElementWarp warp(shapes, packing, 0);
    // Half-way between the two, to the right of the first one's centre.
    const ElementWarp::At at = warp({apart / 2.0, 0});
    CHECK(std::abs(shapes[0].depth_between(at.x, at.y)) < 1.5);
    // The core stays.
    const ElementWarp::At core = warp({3, 2});
    CHECK(core.x == 3);
    CHECK(core.y == 2);
  }
}

TEST_CASE("stones that meet stay as they are") {
  const Elements elements = squares();
  const ElementShapes shapes = element_shapes(elements, {}, 1, true);
  const ElementPacking packing = two_stones(shapes, side);
  const ElementWarp warp(shapes, packing, 0);
  for (int y = -8; y <= 8; y++)
    for (int x = -18; x <= 18; x++) {
      const ElementWarp::At at = warp({double(x), double(y)});
      CHECK(at.x == x);
      CHECK(at.y == y);
    }
}

TEST_CASE("what is shown moves steadily outwards along every ray") {
  const Elements elements = squares();
  const ElementShapes shapes = element_shapes(elements, {}, 1, true);
  const ElementPacking packing = two_stones(shapes, side - 12);
  const ElementWarp warp(shapes, packing, 0);
  for (int angle = 0; angle < 16; angle++) {
    const double x = std::cos(angle * 0.3927), y = std::sin(angle * 0.3927);
    double before = 0;
    for (double r = 1; r < 14; r++) {
      const ElementWarp::At at = warp({x * r, y * r});
      const double now = at.x * x + at.y * y;
      CHECK(now > before);
      CHECK(std::abs(at.x * y - at.y * x) < 1e-6);
      before = now;
    }
  }
}
