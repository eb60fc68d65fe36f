#include "core/exemplar/element_lattice.h"

#include <algorithm>
#include <cstdlib>

#include <doctest/doctest.h>

#include "core/base/hash.h"

using namespace terrazzo;

namespace {

/// Each pixel belongs to one of 24 points, around the borders.
Elements stones_around(Size size) {
  Elements out{size, {}, 24, 1};
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      int nearest = 0, least = 1 << 30;
      for (int i = 0; i < out.count; i++) {
        const uint64_t r = random_bits(3, i);
        int dx = std::abs(int(r % size.width) - x), dy = std::abs(int(r / 97 % size.height) - y);
        dx = std::min(dx, size.width - dx), dy = std::min(dy, size.height - dy);
        if (dx * dx + dy * dy < least) nearest = i, least = dx * dx + dy * dy;
      }
      out.at.push_back(uint16_t(nearest));
    }
  return out;
}

/// Two courses of two bricks, the lower ones so many pixels farther on.
Elements four_bricks(int shift) {
  Elements out{{128, 80}, {}, 4, 1};
  for (int y = 0; y < 80; y++)
    for (int x = 0; x < 128; x++) out.at.push_back(uint16_t(y / 40 * 2 + (x + (y < 40 ? 0 : shift)) % 128 / 64));
  return out;
}

void check_steps(const Lattice& l, const Vector2d& first, const Vector2d& second) {
  CHECK(l.rank == 2);
  CHECK(l.first == first);
  CHECK(l.second == second);
}

}  // namespace

TEST_CASE("elements are in step with a lattice if joints come again one step further along both of its steps") {
  Elements grid{{96, 96}, {}, 16, 1};
  for (int y = 0; y < 96; y++)
    for (int x = 0; x < 96; x++) grid.at.push_back(uint16_t(x / 24 + y / 24 * 4));
  const Lattice cells{2, {24, 0}, {0, 24}, 0}, sheared{2, {24, 0}, {12, 24}, 0};
  CHECK(are_in_step(grid, cells, true));
  CHECK(are_in_step(grid, cells, false));
  CHECK(!are_in_step(grid, sheared, true));
  CHECK(!are_in_step(stones_around({96, 96}), cells, false));
  CHECK(!are_in_step(grid, Lattice{1, {24, 0}, {}, 1}, true));
  CHECK(!are_in_step(Elements{{8, 8}, std::vector<uint16_t>(64), 1, 1}, cells, false));
  // So small that every pixel is near a joint: nothing is told.
  Elements crumbs{{96, 96}, {}, 24 * 24, 1};
  for (int y = 0; y < 96; y++)
    for (int x = 0; x < 96; x++) crumbs.at.push_back(uint16_t(x / 4 + y / 4 * 24));
  CHECK(!are_in_step(crumbs, Lattice{2, {6, 0}, {0, 6}, 0}, true));
}

TEST_CASE("few elements have the densest lattice that their joints follow") {
  check_steps(lattice_of_few(four_bricks(0)), {64, 0}, {0, 40});
  check_steps(lattice_of_few(four_bricks(32)), {64, 0}, {32, 40});
  // Bricks that lie anywhere above one another change places in their own course only.
  check_steps(lattice_of_few(four_bricks(16)), {64, 0}, {0, 80});
  CHECK(lattice_of_few(stones_around({128, 96})).rank == 0);
  // Boards of all lengths follow one another by their courses alone.
  Elements boards{{128, 80}, {}, 4, 1};
  for (int y = 0; y < 80; y++)
    for (int x = 0; x < 128; x++) {
      const int u = (x + (y < 40 ? 0 : 90)) % 128;
      boards.at.push_back(uint16_t(y / 40 * 2 + (u < (y < 40 ? 30 : 75))));
    }
  CHECK(lattice_of_few(boards, {1, {0, 40}, {}, 0.9}).rank == 0);
  check_steps(lattice_of_few(four_bricks(32), {1, {0, 40}, {}, 0.9}), {64, 0}, {32, 40});
  // Bricks that change places with those of any course keep to courses.
  CHECK(lattice_of_few(four_bricks(16), {1, {0, 40}, {}, 0.9}).rank == 0);
  CHECK(lattice_of_few(Elements{{8, 8}, std::vector<uint16_t>(64), 1, 1}).rank == 0);
}
