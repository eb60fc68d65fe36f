#include "core/analysis/repeats/straight_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>

#include "core/analysis/repeats/regularity.h"
#include "tests/exemplars.h"
#include "tests/lattices.h"
#include "tests/overrides.h"

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

TEST_CASE("two by two tiles, and two courses of two stones, are told by their joints, however uneven those are") {
  // Stones of their own grey, 80 x 60, whose hand-laid joints wander by up to three pixels.
  const auto wall = [](int shift) {
    return plain_features(make_image({160, 120}, 1,
                                     [shift](int i, int j, int) {
                                       const auto wander = [](int kind, int at) {
                                         return int(random_bits(kind, at / 12) % 7) - 3;
                                       };
                                       const int y = wrap(j + wander(1, i), 120), row = y / 60;
                                       const int x = wrap(i + row * shift + wander(2, j), 160);
                                       const double grain = 0.1 * unit_double(random_bits(3, i, j));
                                       if (y % 60 < 5 || x % 80 < 5) return float(0.9 + grain);
                                       return float(0.2 + 0.2 * unit_double(random_bits(9, row, x / 80)) + grain);
                                     }),
                          true);
  };
  const auto check_steps = [&](int shift, const Vector2d& first, const Vector2d& second) {
    const Lattice found = find_lattice(*wall(shift), 0.08, Task()).lattice;
    CHECK(found.rank == 2);
    CHECK(found.first == first);
    CHECK(found.second == second);
  };
  check_steps(0, {80, 0}, {0, 60});
  check_steps(25, {80, 0}, {0, 120});
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

TEST_CASE("seams between plates with a fine pattern make cells as large as the plates") {
  const auto plates = [](bool seams) {
    return plain_features(make_image({192, 192}, 1,
                                     [seams](int i, int j, int) {
                                       const double grain = unit_double(random_bits(6, i, j));
                                       if (seams && (i % 96 < 8 || j % 96 < 8)) return float(0.8 + 0.1 * grain);
                                       return float((i % 8 < 4) == (j % 8 < 4) ? 0.3 : 0) + float(0.1 * grain);
                                     }),
                          true);
  };
  const Lattice found = find_lattice(*plates(true), 0.08, Task()).lattice;
  REQUIRE(found.rank == 2);
  CHECK(found.cell_area() == doctest::Approx(96 * 96));
  CHECK(find_lattice(*plates(false), 0.08, Task()).lattice.cell_area() < 20 * 20);
}

TEST_CASE("panels over a rail that comes once are as wide as a panel, and as high as both") {
  const auto wall = plain_features(make_image({192, 192}, 1,
                                              [](int i, int j, int) {
                                                const double grain = 0.2 * unit_double(random_bits(6, i / 2, j / 2));
                                                if (j < 60) return float((j < 4 || j >= 56 ? 0.1 : 0.7) + grain);
                                                const bool frame = i % 64 < 6 || i % 64 >= 58 || j < 66 || j >= 186;
                                                return float((frame ? 0 : 0.8) + grain);
                                              }),
                                   true);
  const Lattice found = find_lattice(*wall, 0.08, Task()).lattice;
  REQUIRE(found.rank == 2);
  CHECK(repeats_by(found, 64, 0));
  CHECK(repeats_by(found, 0, 192));
  CHECK(found.cell_area() == doctest::Approx(64 * 192));
}

TEST_CASE("bands that miss the lines of an exemplar do not hide its cell, those that agree with them are part of it") {
  // Joints along both borders, and one more upright one.
  const auto lattice = [](int joint, double band) {
    Planes outlines{{96, 96}, 1, true, std::vector<float>(96 * 96, 0.f)};
    for (int i = 0; i < 96 * 96; i++)
      if (i % 96 < 2 || i / 96 < 4 || (i % 96 >= joint && i % 96 < joint + 2)) outlines.values[size_t(i)] = 1;
    return lattice_of_lines(outlines, correlate(outlines, {}, Task()), {1, {band, 0}, {}, 0.9});
  };
  const Lattice missed = lattice(70, 12), agree = lattice(48, 48);
  REQUIRE(missed.rank == 2);
  CHECK(missed.cell_area() == doctest::Approx(96 * 96));
  REQUIRE(agree.rank == 2);
  CHECK(agree.cell_area() == doctest::Approx(48 * 96));
}

TEST_CASE("lines of one axis make up for few of the other, unless they are enough for courses") {
  // Of each upright line only a part is there.
  const auto lattice = [](double along, double down) {
    Planes outlines{{96, 96}, 1, true, std::vector<float>(96 * 96)};
    for (int i = 0; i < 96 * 96; i++) {
      const bool line = (i / 96 % 96 < 3 && i % 96 < 96 * along) || (i % 96 < 3 && i / 96 < 96 * down);
      outlines.values[size_t(i)] = line ? 1 : 0.5f * float(unit_double(random_bits(6, i)));
    }
    return lattice_of_lines(outlines, correlate(outlines, {}, Task()), {});
  };
  CHECK(lattice(0.8, 0.6).cell_area() == doctest::Approx(96 * 96));
  CHECK(lattice(0.8, 0.1).rank == 0);
  CHECK(lattice(1, 0.1).rank <= 1);
}

TEST_CASE("two by two chequered tiles that wrap repeat with their colours") {
  const auto floor = plain_features(make_image({96, 96}, 1,
                                               [](int i, int j, int) {
                                                 const double grain = unit_double(random_bits(6, i, j));
                                                 return float((i < 48) == (j < 48) ? 1 : 0) + float(0.2 * grain);
                                               }),
                                    true);
  const Lattice found = find_lattice(*floor, 0.08, Task()).lattice;
  REQUIRE(found.rank == 2);
  CHECK(repeats_by(found, 48, 48));
  CHECK(repeats_by(found, 96, 0));
  CHECK(found.cell_area() == doctest::Approx(2 * 48 * 48));
}

TEST_CASE("clouds that fade over many lines are no cells, joints across them are") {
  const auto surface = [](bool joints) {
    return plain_features(
        make_image({128, 128}, 1,
                   [joints](int x, int y, int) {
                     const auto fade = [](int at) { return std::cos(at * 2 * std::numbers::pi / 128); };
                     const double cloud = std::exp(2 * (fade(x) + fade(y)) - 4);
                     const bool joint = joints && (x < 3 || y < 3);
                     return float(3 * cloud + (joint ? 1 : 0) + 0.02 * unit_double(random_bits(6, x, y)));
                   }),
        true);
  };
  CHECK(find_lattice(*surface(false), 0.08, Task()).lattice.rank == 0);
  CHECK(find_lattice(*surface(true), 0.08, Task()).lattice.rank == 2);
  const TuningOverride soft_lines_count("straight_lines.least_sharp", 0);
  CHECK(find_lattice(*surface(false), 0.08, Task()).lattice.rank == 2);
}

TEST_CASE("boards between posts are one cell, also if they do not tile, boards from border to border are courses") {
  const auto boards = [](bool posts) {
    return plain_features(make_image({192, 192}, 1, [posts](int x, int y, int) {
      const double grain = 0.3 * unit_double(random_bits(7, y / 2, (x + 17 * y) / 30));
      const int at = std::min(x, 191 - x);
      if (posts && at < 12) return float(at % 6 < 2 ? 0 : 1.2 + grain);
      return float((y + 9) % 32 < 3 ? -1.5 : 0.6 + grain);
    }));
  };
  for (const bool posts : {true, false}) {
    CAPTURE(posts);
    const FoundLattice found = find_lattice(*boards(posts), 0.08, Task());
    CHECK(found.lattice.rank == (posts ? 2 : 1));
    CHECK(found.lattice.is_single_cell({192, 192}) == posts);
    CHECK(found.too_few == posts);
  }
}

TEST_CASE("unequal panels between joints that run half the exemplar in both directions are one cell") {
  // Joints at (from, to) along and at a place across, of the panels and of courses of bricks of any length.
  struct Joint {
    bool level;
    int at, from, to;
  };
  const auto find = [](const std::vector<Joint>& joints, bool wraps = true) {
    return find_lattice(*plain_features(make_image({192, 192}, 1,
                                                   [&](int x, int y, int) {
                                                     const double grain = 0.3 * unit_double(random_bits(4, x, y));
                                                     for (const Joint& j : joints) {
                                                       const int across = j.level ? y : x, along = j.level ? x : y;
                                                       if (across >= j.at && across < j.at + 4 && along >= j.from &&
                                                           along < j.to)
                                                         return float(0.1 + grain);
                                                     }
                                                     return float(0.6 + grain);
                                                   }),
                                        wraps),
                        0.08, Task())
        .lattice;
  };
  const std::vector<Joint> panels = {{true, 10, 0, 192},   {true, 78, 30, 150},  {true, 131, 0, 96},
                                     {false, 30, 10, 131}, {false, 96, 78, 192}, {false, 150, 10, 192},
                                     {false, 121, 78, 192}};
  CHECK(find(panels).is_single_cell({192, 192}));
  // Of an exemplar that does not tile, lines must go on for longer.
  const std::vector<Joint> rail = {{true, 24, 0, 192}, {false, 60, 28, 190}, {false, 110, 28, 190}};
  CHECK(find(rail, false).is_single_cell({192, 192}));
  std::vector<Joint> courses;
  for (int course = 0; course < 8; course++) {
    courses.push_back({true, 24 * course, 0, 192});
    for (int x = 7 * course; x < 192; x += 30 + int(random_bits(8, x, course) % 50))
      courses.push_back({false, x, 24 * course, 24 * course + 24});
  }
  const Lattice wall = find(courses);
  CHECK(wall.rank == 1);
  CHECK(wall.first.y() == doctest::Approx(24));
}

TEST_CASE("tiles of which the joints along one axis are faint are no courses") {
  const FeaturesPtr tiles =
      plain_features(make_image({192, 192}, 1,
                                [](int x, int y, int) {
                                  double grain = 0;
                                  for (int k = 0; k < 9; k++)
                                    grain += unit_double(random_bits(6, (x + k % 3) / 3, (y + k / 3) / 3)) / 9;
                                  return float(0.5 + grain - (y % 48 < 3 ? 0.7 : x % 48 < 3 ? 0.25 : 0));
                                }),
                     true);
  const Lattice found = find_lattice(*tiles, 0.08, Task()).lattice;
  REQUIRE(found.rank == 2);
  CHECK(repeats_by(found, 192, 0));
  CHECK(repeats_by(found, 0, 48));
}
