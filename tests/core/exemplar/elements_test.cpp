#include "core/exemplar/elements.h"

#include <vector>

#include <doctest/doctest.h>

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
