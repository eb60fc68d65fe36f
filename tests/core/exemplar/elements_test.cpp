#include "core/exemplar/elements.h"

#include <doctest/doctest.h>

#include "core/base/hash.h"

using namespace terrazzo;

TEST_CASE("the typical side is that of the element a pixel is in, not that of the many crumbs") {
  Elements e{{8, 8}, std::vector<uint16_t>(64), 1, 1};
  CHECK(typical_side(e) == 8);
  for (int i = 0; i < 64; i++) e.at[size_t(i)] = uint16_t(i % 8 / 4 + i / 32 * 2);
  e.count = 4;
  CHECK(typical_side(e) == 4);
  for (uint16_t i = 0; i < 16; i++) e.at[i] = uint16_t(4 + i);
  e.count = 20;
  CHECK(typical_side(e) > 3);
}

TEST_CASE("joints in step are those that come again one step further along both steps of a lattice") {
  Elements grid{{96, 96}, {}, 16, 1}, stones = grid;
  for (int y = 0; y < 96; y++)
    for (int x = 0; x < 96; x++) {
      grid.at.push_back(uint16_t(x / 24 + y / 24 * 4));
      int nearest = 0, least = 1 << 30;
      for (int i = 0; i < 16; i++) {
        const uint64_t r = random_bits(3, i);
        const int dx = int(r % 96) - x, dy = int(r / 96 % 96) - y;
        if (dx * dx + dy * dy < least) nearest = i, least = dx * dx + dy * dy;
      }
      stones.at.push_back(uint16_t(nearest));
    }
  const Lattice cells{2, {24, 0}, {0, 24}, 0}, sheared{2, {24, 0}, {12, 24}, 0};
  CHECK(joints_in_step(grid, cells, true) > 0.99);
  CHECK(joints_in_step(grid, cells, false) > 0.99);
  CHECK(joints_in_step(grid, sheared, true) < 0.75);
  CHECK(joints_in_step(stones, cells, false) < 0.3);
  CHECK(joints_in_step(grid, Lattice{1, {24, 0}, {}, 1}, true) == 0);
  CHECK(joints_in_step(Elements{{8, 8}, std::vector<uint16_t>(64), 1, 1}, cells, false) == 0);
  // So small that every pixel is near a joint: nothing is told.
  Elements crumbs{{96, 96}, {}, 24 * 24, 1};
  for (int y = 0; y < 96; y++)
    for (int x = 0; x < 96; x++) crumbs.at.push_back(uint16_t(x / 4 + y / 4 * 24));
  CHECK(joints_in_step(crumbs, Lattice{2, {6, 0}, {0, 6}, 0}, true) == 0);
}
