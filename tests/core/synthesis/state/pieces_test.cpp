#include "core/synthesis/state/pieces.h"

#include <doctest/doctest.h>

#include "tests/core/synthesis/fields.h"
#include "tests/core/synthesis/slopes.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// Pixels that show the exemplar moved by `left` up to column 3, by `right` beyond it.
Field two_parts(int left, int right) {
  Field field{{6, 4}, {}};
  for (int y = 0; y < 4; y++)
    for (int x = 0; x < 6; x++) field.pixels.push_back({uint16_t((x + (x < 3 ? left : right)) % 10), uint16_t(y + 1)});
  return field;
}

/// The pieces of what shows an exemplar of 10x10 pixels.
Pieces pieces_of(const Field& field, bool exemplar_tiles = false, bool closed_x = false, bool closed_y = false,
                 int block = 1) {
  const PaddedLevel exemplar = slopes({10, 10}, {}, exemplar_tiles);
  CorrectionLevel level = level_of(exemplar, field.size);
  level.window = PlaneWindow::all_of({field.size, closed_x, closed_y});
  level.block = block;
  return Pieces(field, level);
}

}  // namespace

TEST_CASE("pixels that continue one another are one piece, in the order of first pixels") {
  const Pieces pieces = pieces_of(two_parts(1, 3));
  CHECK(pieces.count() == 2);
  CHECK(pieces.members(0) == std::vector<int>{0, 1, 2, 6, 7, 8, 12, 13, 14, 18, 19, 20});
  CHECK(pieces.area(0) == 12);
  CHECK(pieces.area(1) == 12);
  CHECK(pieces.members(1)[0] == 3);
  CHECK(pieces.members(1).back() == 23);
}

TEST_CASE("a piece ends at the exemplar's border, or goes on around it if the exemplar tiles") {
  // Columns 7, 8, 9, 0, 1, 2 of the exemplar.
  CHECK(pieces_of(two_parts(7, 7)).count() == 2);
  CHECK(pieces_of(two_parts(7, 7), true).count() == 1);
  const Field down{{1, 3}, {{3, 9}, {3, 0}, {3, 1}}};
  CHECK(pieces_of(down).count() == 2);
  CHECK(pieces_of(down, true).count() == 1);
  const Field blocks{{2, 1}, {{9, 4}, {1, 4}}};
  CHECK(pieces_of(blocks, false, false, false, 2).count() == 2);
  CHECK(pieces_of(blocks, true, false, false, 2).count() == 1);
}

TEST_CASE("a piece goes on around the borders of a field that wraps, and only there") {
  // Columns 4, 5, 6, 1, 2, 3 of the exemplar: what the last shows goes on in the first.
  const Field across = two_parts(4, 8);
  CHECK(pieces_of(across).count() == 2);
  CHECK(pieces_of(across, false, false, true).count() == 2);
  CHECK(pieces_of(across, false, true).count() == 1);
  const Field down{{1, 4}, {{3, 6}, {3, 7}, {3, 4}, {3, 5}}};
  CHECK(pieces_of(down, false, true, false).count() == 2);
  CHECK(pieces_of(down, false, false, true).count() == 1);
  const Field blocks{{1, 2}, {{3, 6}, {3, 4}}};
  CHECK(pieces_of(blocks, false, false, true, 2).count() == 1);
}

TEST_CASE("diagonal neighbours alone do not join") {
  const Field field{{2, 2}, {{1, 1}, {5, 5}, {4, 0}, {2, 2}}};
  CHECK(pieces_of(field).count() == 4);
}
