#include "core/analysis/repeats/straight_lines.h"

#include <doctest/doctest.h>

#include "core/analysis/repeats/regularity.h"
#include "tests/exemplars.h"
#include "tests/lattices.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("two by two tiles that wrap are told by thin joints, and so are two courses of blocks in a bond") {
  const auto wall = [](double shift) {
    return plain_features(make_image({192, 192}, 1,
                                     [shift](int i, int j, int) {
                                       double grain = 0;
                                       for (int k = 0; k < 9; k++)
                                         grain += unit_double(random_bits(6, (i + k % 3) / 3, (j + k / 3) / 3)) / 9;
                                       const int course = j / 96, x = wrap(i + int(shift * course), 192);
                                       const bool head = shift == 0 ? x % 96 < 4 : x < 4;
                                       return float(0.5 + grain - (j % 96 < 3 ? 0.7 : head ? 0.7 : 0));
                                     }),
                          true);
  };
  for (const double shift : {0.0, 96.0}) {
    CAPTURE(shift);
    const Lattice found = find_lattice(*wall(shift), 0.08, Task()).lattice;
    REQUIRE(found.rank == 2);
    CHECK(found.cell_area() == doctest::Approx(shift == 0 ? 96 * 96 : 192 * 96).epsilon(0.02));
    CHECK(repeats_by(found, shift == 0 ? 96 : 192, 0));
    CHECK(repeats_by(found, shift, 96));
  }
}
