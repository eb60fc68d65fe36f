#include "core/exemplar/repeats.h"

#include <cmath>

#include <doctest/doctest.h>

using namespace terrazzo;

namespace {

constexpr Size exemplar{100, 40}, output{200, 200};
const Lattice tiles{2, {10, 0}, {0, 8}, 1};

/// Tiles on the left; from column 50 on the same, three pixels further right and two further down.
Repeats two_alike() {
  return Repeats(
      std::vector<LatticePart>{{{0, 0, 46, 40}, tiles, tiles, {}}, {{50, 0, 50, 40}, tiles, tiles, {53, 2}}});
}

PartPhases phases(const Repeats& repeats, int level = 0) {
  return {repeats, {exemplar.width >> level, exemplar.height >> level}, level, {output}};
}

}  // namespace

TEST_CASE("each part of an exemplar is in phase where its own start says") {
  const PartPhases p = phases(two_alike());
  CHECK(p.active());
  CHECK(p.resolves_cells());
  CHECK(p.penalty(21, 9, 131, 65) == 1);
  CHECK(p.penalty(24, 11, 131, 65) > 2);
  CHECK(p.penalty(64, 11, 131, 65) == 1);
  CHECK(p.penalty(61, 9, 131, 65) > 2);
  int u = 62, v = 12;
  p.snap(131, 65, u, v);
  CHECK(u == 64);
  CHECK(v == 11);
}

TEST_CASE("gaps between parts, and what lies outside, go by the nearest part") {
  const PartPhases p = phases(two_alike());
  CHECK(p.penalty(47, 1, 37, 1) == 1);
  CHECK(p.penalty(49, 1, 39, 1) > 2);
  CHECK(p.penalty(49, 1, 36, 7) == 1);
  CHECK(p.penalty(-3, -7, 7, 1) == 1);
}

TEST_CASE("what does not repeat is never out of phase, what repeats beside it still can be") {
  const PartPhases p =
      phases(Repeats(std::vector<LatticePart>{{{0, 0, 50, 40}, {}, {}, {}}, {{50, 0, 50, 40}, tiles, tiles, {}}}));
  CHECK(p.active());
  for (const int u : {0, 3, 7}) CHECK(p.penalty(u, u, 0, 0) == 1);
  CHECK(p.penalty(53, 3, 0, 0) > 2);
  int u = 7, v = 3;
  p.snap(0, 0, u, v);
  CHECK(u == 7);
  CHECK_FALSE(phases(Repeats(std::vector<LatticePart>{{{0, 0, 100, 40}, {}, {}, {}}})).active());
}

TEST_CASE("a part is shown at the size of another, cell by cell") {
  const Lattice larger{2, {10.5, 0}, {0, 8}, 1};
  const PartPhases p = phases(
      Repeats(std::vector<LatticePart>{{{0, 0, 50, 40}, tiles, tiles, {}}, {{50, 0, 50, 40}, larger, tiles, {50, 0}}}));
  CHECK(p.penalty(92, 0, 40, 0) == 1);
  CHECK(p.penalty(90, 0, 40, 0) > 2);
}

TEST_CASE("coarse levels tell parts apart by the pixels' middles") {
  // The second part begins at a quarter of a pixel, so pixel 12 lies in it but for its first column.
  const Repeats two(
      std::vector<LatticePart>{{{0, 0, 49, 40}, tiles, tiles, {}}, {{49, 0, 51, 40}, tiles, tiles, {52, 4}}});
  const PartPhases p = phases(two, 2);
  CHECK(p.penalty(5, 4, 5, 4) == 1);
  CHECK(p.penalty(13, 1, 0, 0) == 1);
  int u = 15, v = 2;
  p.snap(0, 0, u, v);
  CHECK(p.penalty(u, v, 0, 0) == 1);
  CHECK(p.penalty(12, 2, -5, -3) == p.penalty(13, 3, 0 - 4, 0 - 2));
}

TEST_CASE("where an exemplar position is shown can be asked, and what lies there is in phase with it") {
  const PartPhases p = phases(two_alike());
  for (const int u : {5, 60, 77}) {
    const Vector2d at = p.shown_at(u, 13);
    CHECK(p.penalty(u, 13, at.x(), at.y()) == 1);
  }
  const Vector2d one = PartPhases(tiles, exemplar, 0, {output}).shown_at(33, 7);
  CHECK(one.x() == 33);
  CHECK(one.y() == 7);
}

TEST_CASE("the largest part that repeats speaks for all") {
  const Lattice courses{1, {0, 9}, {}, 0.5};
  const Repeats r(std::vector<LatticePart>{
      {{0, 0, 90, 40}, {}, {}, {}}, {{90, 0, 4, 40}, tiles, tiles, {}}, {{94, 0, 6, 40}, courses, courses, {}}});
  CHECK(r.lattice.rank == 1);
  CHECK(r.lattice.first.y() == 9);
}
