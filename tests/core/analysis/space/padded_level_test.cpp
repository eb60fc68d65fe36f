#include "core/analysis/space/padded_level.h"

#include <doctest/doctest.h>

using namespace terrazzo;

namespace {

/// Every vector tells its position.
AppearanceLevel numbered_level(Size size) {
  AppearanceLevel level;
  level.size = size;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      AppearanceVector v{};
      v[0] = int16_t(x);
      v[1] = int16_t(y);
      level.vectors.push_back(v);
    }
  return level;
}

}  // namespace

TEST_CASE("beyond its border lies the other side of a level that tiles, others are mirrored") {
  const PaddedLevel mirrored(numbered_level({9, 7}), false), tiles(numbered_level({9, 7}), true);
  const auto shows = [](const PaddedLevel& level, int x, int y, int u, int v) {
    const AppearanceVector& a = *level.at(x, y);
    return a[0] == u && a[1] == v;
  };
  for (const PaddedLevel* level : {&mirrored, &tiles}) {
    CHECK(shows(*level, 0, 0, 0, 0));
    CHECK(shows(*level, 8, 6, 8, 6));
  }
  CHECK(shows(mirrored, -1, 3, 1, 3));
  CHECK(shows(mirrored, -4, 3, 4, 3));
  CHECK(shows(mirrored, 9, 3, 7, 3));
  CHECK(shows(mirrored, 12, 10, 4, 2));
  CHECK(shows(tiles, -1, 3, 8, 3));
  CHECK(shows(tiles, -4, 3, 5, 3));
  CHECK(shows(tiles, 9, 3, 0, 3));
  CHECK(shows(tiles, 12, 10, 3, 3));
}

TEST_CASE("a level smaller than its margin is padded with its own pixels") {
  for (const bool wraps : {false, true})
    for (const Size size : {Size{1, 1}, Size{2, 3}}) {
      const PaddedLevel padded(numbered_level(size), wraps);
      for (int y = -PaddedLevel::margin; y < size.height + PaddedLevel::margin; y++)
        for (int x = -PaddedLevel::margin; x < size.width + PaddedLevel::margin; x++) {
          const AppearanceVector& a = *padded.at(x, y);
          CHECK((a[0] >= 0 && a[0] < size.width && a[1] >= 0 && a[1] < size.height));
        }
    }
}

TEST_CASE("positions beyond the border settle inside: around it if the exemplar tiles") {
  const PaddedLevel tiles(numbered_level({80, 90}), true), other(numbered_level({80, 90}), false);
  int x = 83, y = -5;
  tiles.settle_inside(x, y);
  CHECK((x == 3 && y == 85));
  CHECK(tiles.keep_off() == 0);
  x = 83, y = -5;
  other.unwind(x, y);
  CHECK((x == 83 && y == -5));
  other.settle_inside(x, y);
  CHECK((x == 79 - other.keep_off() && y == other.keep_off()));
  CHECK(other.keep_off() > 0);
}
