#include "core/exemplar/lattice.h"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "core/base/hash.h"

using namespace terrazzo;

namespace {

constexpr Size output{512, 512};

Lattice courses(double height, double certainty = 0.5) {
  return {1, {0, height}, {}, certainty};
}

}  // namespace

TEST_CASE("in phase is what lies a whole number of cells apart") {
  const Lattice grid{2, {10, 0}, {5, 8}, 0.5};
  const LatticePhase phase(grid, 0, {output, false, false});
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
  // Three pixels of level 3 are 24 of the finest, four courses; a third of them is none.
  const LatticePhase phase(courses(6), 3, {output, false, false});
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
  // Those of level 4 are larger than two courses.
  CHECK_FALSE(LatticePhase(courses(6), 4, {output, false, false}).active());
}

TEST_CASE("where cells are not resolved, snapping finds the best of all places in reach") {
  const Vector2d origin{3.7, 1.2};
  for (const Lattice& lattice : {Lattice{2, {17.3, 4.1}, {-6.2, 21.9}, 0.7}, Lattice{2, {40, 0}, {31, 5}, 0.2},
                                 Lattice{1, {11.7, 0}, {}, 0.4}, Lattice{1, {0, 9.2}, {}, 0.9}})
    for (int level = 2; level <= 5; level++) {
      CAPTURE(lattice.first.x());
      CAPTURE(level);
      const LatticePhase phase(lattice, level, {output, true, false, origin});
      if (phase.resolves_cells() || !phase.active()) continue;
      for (int i = 0; i < 1000; i++) {
        const uint64_t r = random_bits(level, i);
        const int x = int(r & 63), y = int(r >> 8 & 63), u = int(r >> 16 & 63), v = int(r >> 24 & 63);
        const auto cost_of = [&](int to_u, int to_v) {
          return phase.penalty(to_u, to_v, x, y) + 0.001 * ((to_u - u) * (to_u - u) + (to_v - v) * (to_v - v));
        };
        double least = 1e9;
        for (int dy = -3; dy <= 3; dy++)
          for (int dx = -3; dx <= 3; dx++) least = std::min(least, cost_of(u + dx, v + dy));
        int to_u = u, to_v = v;
        phase.snap(x, y, to_u, to_v);
        REQUIRE(cost_of(to_u, to_v) == doctest::Approx(least).epsilon(1e-9));
      }
    }
}

TEST_CASE("cells are whole where the exemplar's and those that are shown are whole pixels, in both directions") {
  const Lattice drawn{2, {12, 0}, {6, 9}, 1}, photographed{2, {12.25, 0}, {6, 9}, 1};
  CHECK(LatticePhase(drawn, 0, {output}).is_whole());
  CHECK_FALSE(LatticePhase(photographed, 0, {output}).is_whole());
  CHECK_FALSE(LatticePhase(drawn, photographed, {}, 0, {output}).is_whole());
  CHECK_FALSE(LatticePhase(courses(12), 0, {output}).is_whole());
  CHECK(LatticePhase(drawn, 0, {{240, 180}, true, true}).is_whole());
  CHECK_FALSE(LatticePhase(drawn, 0, {{250, 180}, true, true}).is_whole());
  CHECK_FALSE(LatticePhase(drawn, 0, {{250, 180}, true, false, {}, {{50, 100}, {}}}).is_whole());
}

TEST_CASE("the surer the lattice, the more it costs to be out of phase") {
  const LatticePhase unsure(courses(25, 0.1), 0, {output, false, false}),
      sure(courses(25, 0.9), 0, {output, false, false});
  CHECK(sure.penalty(0, 4, 0, 0) > unsure.penalty(0, 4, 0, 0));
  // What rounding to whole pixels takes costs nothing, however sure it is.
  const LatticePhase fine(courses(6.5, 1), 0, {output, false, false});
  CHECK(fine.penalty(0, 7, 0, 0) == 1);
  CHECK(fine.penalty(0, 6, 0, 0) == 1);
}

TEST_CASE("on a surface that wraps around the lattice is stretched to whole cells") {
  const LatticePhase phase(courses(30), 0, {{300, 310}, false, true});
  // 310 pixels hold ten courses of 31.
  CHECK(phase.penalty(0, 300, 0, 310) == 1);
  CHECK(phase.penalty(0, 150, 0, 155) == 1);
}

TEST_CASE("a lattice knows its level courses and its columns, and how they run") {
  const Lattice bricks{2, {128, 1}, {64, 43}, 1};
  CHECK(bricks.along_bands(true).x() == doctest::Approx(128));
  CHECK(bricks.along_bands(true).y() == doctest::Approx(1));
  CHECK(bricks.level_bands(true).rank == 1);
  CHECK(bricks.level_bands(true).first.y() == doctest::Approx(bricks.cell_area() / 128));
  // Straight up it comes back after two courses only, and not quite.
  CHECK(bricks.level_bands(false).first.x() == doctest::Approx(64).epsilon(0.01));
  CHECK(courses(6).along_bands(true).x() > 0);
  CHECK(courses(6).along_bands(false).y() == 0);
  CHECK(courses(6).level_bands(false).rank == 0);
  const Lattice turned{2, {29, 13}, {-13, 29}, 1};
  CHECK(turned.along_bands(true).x() == 0);
  CHECK(turned.level_bands(true).rank == 0);
}

TEST_CASE("what a surface misses to a whole number of cells") {
  const Lattice bricks{2, {40, 0}, {18, 30}, 0.5};
  CHECK(bricks.misfit(203, true).x() == doctest::Approx(3));
  CHECK(bricks.misfit(203, true).y() == doctest::Approx(0));
  CHECK(bricks.misfit(61, false).y() == doctest::Approx(1));
  CHECK(bricks.misfit(61, false).x() == doctest::Approx(4));
  CHECK(courses(12).misfit(34, false).y() == doctest::Approx(-2));
  CHECK(courses(12).misfit(34, true).x() == 0);
}

TEST_CASE("between kept pixels a lattice bends until it wraps, and stays as it is among them") {
  // 100 pixels hold six and a quarter cells; 20 before the border and 20 behind it are free.
  const Lattice grid{2, {16, 0}, {0, 16}, 1};
  const LatticePhase phase(grid, 0, {{100, 64}, true, true, {}, {{80, 40}, {}}});
  for (int x = 20; x < 80; x++) CHECK(std::abs(phase.excess(x, 5, x, 5).x()) < 1e-9);
  // What exceeds a whole number of cells is taken away bit by bit.
  double last = 0;
  for (int i = 1; i < 40; i++) {
    const int x = (80 + i) % 100;
    const Vector2d e = phase.excess(80 + i, 9, x, 9);
    CAPTURE(x);
    CHECK(e.x() == doctest::Approx(i * 4.0 / 40).epsilon(1e-9));
    CHECK(e.x() > last);
    last = e.x();
    CHECK(std::abs(e.y()) < 1e-9);
  }
  // Coarser levels bend alike.
  const LatticePhase coarse(grid, 2, {{100, 64}, true, true, {}, {{80, 40}, {}}});
  CHECK(coarse.excess(100 / 4, 2, 0, 2).x() == doctest::Approx(2.0 / 4));
}
