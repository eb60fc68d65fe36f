#include "core/synthesis/steps/element_shapes.h"

#include <doctest/doctest.h>

using namespace terrazzo;

namespace {

/// Four by four elements of 20x20 pixels.
Elements squares() {
  Elements e{{80, 80}, {}, 16, 1};
  for (int y = 0; y < 80; y++)
    for (int x = 0; x < 80; x++) e.at.push_back(uint16_t(y / 20 * 4 + x / 20));
  return e;
}

/// The depth so many pixels below the top, and to the right of the left border, of an element.
float depth(const ElementShapes& shapes, int from_left, int from_top) {
  const ElementShape& s = shapes[5];
  return s.depth(from_left + 20 - s.centre_x, from_top + 20 - s.centre_y);
}

}  // namespace

TEST_CASE("distances across sure courses or columns count more than those along them") {
  const Elements elements = squares();
  const auto shapes_of = [&](const Lattice& lattice) { return element_shapes(elements, {}, 1, true, &lattice); };
  const ElementShapes plain = element_shapes(elements, {}, 1, true);
  CHECK(depth(plain, 10, 2) == depth(plain, 2, 10));
  const ElementShapes courses = shapes_of({1, {0, 20}, {}, 0.9}), columns = shapes_of({1, {20, 0}, {}, 0.9});
  CHECK(depth(courses, 2, 10) == doctest::Approx(depth(plain, 2, 10)));
  CHECK(depth(courses, 10, 2) > 2 * depth(plain, 10, 2));
  CHECK(depth(columns, 10, 2) == doctest::Approx(depth(plain, 10, 2)));
  CHECK(depth(columns, 2, 10) > 2 * depth(plain, 2, 10));
  CHECK(depth(courses, 10, -3) < 2 * depth(plain, 10, -3));
  for (const Lattice& other : {Lattice{1, {0, 20}, {}, 0.2}, Lattice{2, {20, 0}, {0, 20}, 0.9}})
    CHECK(shapes_of(other)[5].depths == plain[5].depths);
}

TEST_CASE("tiles of a grid that end at the exemplar's border are whole, those that it cuts are not") {
  const Lattice grid{2, {20, 0}, {0, 20}, 0.9};
  const Elements whole = squares();
  const ElementShapes shapes = element_shapes(whole, {}, 1, false, &grid);
  CHECK(shapes.whole == 16);
  // At the border half of a joint may be missing: nothing is shown from there.
  const ElementShape &corner = shapes[0], &inner = shapes[5];
  CHECK(corner.depth(0 - corner.centre_x, 10 - corner.centre_y) < 0);
  CHECK(corner.depth(3 - corner.centre_x, 10 - corner.centre_y) > 0);
  CHECK(corner.depth(19 - corner.centre_x, 10 - corner.centre_y) > 0);
  CHECK(inner.depth(20 - inner.centre_x, 30 - inner.centre_y) > 0);
  // Seven pixels of those in the first column are missing.
  Elements cut{{73, 80}, {}, 16, 1};
  for (int y = 0; y < 80; y++)
    for (int x = 0; x < 73; x++) cut.at.push_back(whole.at[size_t(y * 80 + x + 7)]);
  const ElementShapes left = element_shapes(cut, {}, 1, false, &grid);
  CHECK(left.whole == 12);
  for (int e = 0; e < 16; e++) CHECK(left[e].unusable == (e % 4 == 0));
}

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
  CHECK(most_cut[0].depth(10 - most_cut[0].centre_x, 0 - most_cut[0].centre_y) < 0);
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
