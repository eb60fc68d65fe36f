#include "core/synthesis/pieces.h"

#include <doctest/doctest.h>

using namespace terrazzo;

namespace {

/// Pixels that show the exemplar moved by `left` up to column 3, by `right` beyond it.
Field two_parts(int left, int right) {
  Field field{{6, 4}, {}};
  for (int y = 0; y < 4; y++)
    for (int x = 0; x < 6; x++) field.pixels.push_back({uint16_t((x + (x < 3 ? left : right)) % 10), uint16_t(y + 1)});
  return field;
}

}  // namespace

TEST_CASE("pixels that continue one another are one piece, in the order of first pixels") {
  const Pieces pieces(two_parts(1, 3));
  CHECK(pieces.count() == 2);
  CHECK(pieces.of(0) == 0);
  CHECK(pieces.of(3) == 1);
  CHECK(pieces.area(0) == 12);
  CHECK(pieces.area(1) == 12);
  CHECK(pieces.members(1)[0] == 3);
  CHECK(pieces.members(1).back() == 23);
}

TEST_CASE("a piece ends at the exemplar's border") {
  // Columns 7, 8, 9, 0, 1, 2 of the exemplar.
  CHECK(Pieces(two_parts(7, 7)).count() == 2);
}

TEST_CASE("diagonal neighbours alone do not join") {
  Field field{{2, 2}, {{1, 1}, {5, 5}, {4, 0}, {2, 2}}};
  CHECK(Pieces(field).count() == 4);
}
