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
