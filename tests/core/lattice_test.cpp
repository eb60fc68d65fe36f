#include "core/lattice.h"

#include <cmath>

#include <doctest/doctest.h>

using namespace terrazzo;

namespace {

constexpr Size output{512, 512};

Lattice courses(double height, double certainty = 0.5) {
  return {1, {0, height}, {}, certainty};
}

}  // namespace

TEST_CASE("in phase is what lies a whole number of cells apart") {
  const Lattice grid{2, {10, 0}, {5, 8}, 0.5};
  const LatticePhase phase(grid, 0, output, false, false);
  CHECK(phase.resolves_cells());
  CHECK(phase.penalty(31, 17, 31, 17) == 1);
  CHECK(phase.penalty(31 + 25, 17 + 8, 31, 17) == 1);
  CHECK(phase.penalty(31 + 5, 17, 31, 17) > 2);
  int u = 40, v = 30;
  phase.snap(3, 4, u, v);
  CHECK(phase.penalty(u, v, 3, 4) == 1);
  CHECK(std::abs(u - 40) <= 5);
  CHECK(std::abs(v - 30) <= 4);
}

TEST_CASE("levels that are too coarse to see a cell still know positions that are in phase at the finest level") {
  // Three pixels of level 4 are 48 of the finest, eight courses; a fourth of them is none.
  const LatticePhase phase(courses(6), 4, output, false, false);
  CHECK(phase.active());
  CHECK_FALSE(phase.resolves_cells());
  CHECK(phase.penalty(0, 3, 0, 0) == 1);
  CHECK(phase.penalty(0, 1, 0, 0) > 2);
  for (int from = 0; from < 6; from++) {
    CAPTURE(from);
    int u = 5, v = from;
    phase.snap(0, 0, u, v);
    CHECK(u == 5);
    CHECK(v % 3 == 0);
    CHECK(std::abs(v - from) <= 1);
  }
  CHECK_FALSE(LatticePhase(courses(6), 8, output, false, false).active());
}

TEST_CASE("the surer the lattice, the more it costs to be out of phase") {
  const LatticePhase unsure(courses(25, 0.1), 0, output, false, false), sure(courses(25, 0.9), 0, output, false, false);
  CHECK(sure.penalty(0, 4, 0, 0) > unsure.penalty(0, 4, 0, 0));
  // What rounding to whole pixels takes costs nothing, however sure it is.
  const LatticePhase fine(courses(6.5, 1), 0, output, false, false);
  CHECK(fine.penalty(0, 7, 0, 0) == 1);
  CHECK(fine.penalty(0, 6, 0, 0) == 1);
}

TEST_CASE("on a surface that wraps around the lattice is stretched to whole cells") {
  const LatticePhase phase(courses(30), 0, {300, 310}, false, true);
  // 310 pixels hold ten courses of 31.
  CHECK(phase.penalty(0, 300, 0, 310) == 1);
  CHECK(phase.penalty(0, 150, 0, 155) == 1);
}
