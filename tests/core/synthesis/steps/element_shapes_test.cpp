#include "core/synthesis/steps/element_shapes.h"

#include <doctest/doctest.h>

using namespace terrazzo;

TEST_CASE("where most of an exemplar lies in stones that its border cuts, those end there") {
  // Columns of stones 20 pixels wide; the upper and the lower row is `rim` pixels high.
  const auto stones = [](int height, int rim) {
    Elements e{{80, height}, {}, 12, 1};
    for (int y = 0; y < height; y++)
      for (int x = 0; x < 80; x++) e.at.push_back(uint16_t((y < rim ? 0 : y < height - rim ? 1 : 2) * 4 + x / 20));
    return e;
  };
  // The whole ones are 2 of 12, with less than a fifth of the area.
  const ElementShapes most_cut = element_shapes(stones(90, 30), {}, 1, false);
  CHECK(most_cut.whole == 12);
  CHECK(most_cut[0].depth(10 - most_cut[0].centre_x, -1 - most_cut[0].centre_y) < 0);
  CHECK(most_cut[0].depth(10 - most_cut[0].centre_x, 15 - most_cut[0].centre_y) > 0);
  // Slivers are not laid: those at the top and the bottom are a quarter as large as the others.
  const ElementShapes slivers = element_shapes(stones(60, 10), {}, 1, false);
  CHECK(slivers.whole == 4);
  for (int e = 0; e < 12; e++) CHECK(slivers[e].unusable == (e / 4 != 1));
  // Of an exemplar that tiles, nothing is cut.
  CHECK(element_shapes(stones(60, 10), {}, 1, true).whole == 12);
}

TEST_CASE("an element wider than half of an exemplar that tiles has its place, wherever the border runs through it") {
  // Seven tenths as wide as the exemplar, with a narrow one beside it; a nose sticks out upwards in its middle.
  for (const int moved : {0, 30, 50, 70}) {
    CAPTURE(moved);
    Elements e{{80, 80}, {}, 2, 1};
    for (int y = 0; y < 80; y++)
      for (int x = 0; x < 80; x++) {
        const int u = wrap(x - moved, 80);
        const bool nose = y < 10 && (u < 26 || u > 30);
        e.at.push_back(u >= 56 || nose || y >= 70 ? 1 : 0);
      }
    const ElementShape wide = element_shapes(e, {}, 1, true)[0];
    CHECK(!wide.unusable);
    CHECK(wide.area == 60 * 56 + 5 * 10);
    CHECK(wrap(wide.centre_x - moved, 80) == 28);
    CHECK(wide.depth(0, 0) > 20);
  }
}
