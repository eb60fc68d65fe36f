#include "core/analysis/repeats/straight_lines.h"

#include <cmath>

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

TEST_CASE("rows that differ at edges come as a band, clouds that are darker in the middle do not") {
  const auto surface = [](bool painted) {
    return plain_features(make_image({256, 256}, 1, [painted](int i, int j, int) {
      double grain = 0;
      for (int k = 0; k < 9; k++) grain += unit_double(random_bits(6, (i + k % 3) / 3, (j + k / 3) / 3)) / 9;
      const double cloud = std::cos(j * 2 * 3.14159265358979 / 256), stripe = j < 128 ? 1 : -1;
      return float(0.3 * (painted ? stripe : cloud) + 0.5 * grain);
    }));
  };
  const Lattice found = find_lattice(*surface(true), 0.08, Task()).lattice;
  CHECK(found.rank == 1);
  CHECK(found.first.y() == 256);
  CHECK(find_lattice(*surface(false), 0.08, Task()).lattice.rank == 0);
}
