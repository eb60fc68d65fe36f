#include "core/base/disjoint_sets.h"

#include <doctest/doctest.h>

using namespace terrazzo;

TEST_CASE("joined numbers are found under their smallest, in whatever order they were joined") {
  for (const bool backwards : {false, true}) {
    DisjointSets sets(6);
    backwards ? sets.join(5, 3) : sets.join(1, 3);
    backwards ? sets.join(3, 1) : sets.join(3, 5);
    sets.join(1, 1);
    for (const uint32_t member : {1u, 3u, 5u}) CHECK(sets.find(member) == 1);
    for (const uint32_t alone : {0u, 2u, 4u}) CHECK(sets.find(alone) == alone);
  }
}
