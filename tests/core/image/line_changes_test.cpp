#include "core/image/line_changes.h"

#include <doctest/doctest.h>

using namespace terrazzo;

namespace {

/// A line every 16 pixels, upright ones moved by half of that from one part of so many rows to the next.
Planes lines(Size size, bool level, int part, bool wraps = true) {
  Planes out = Planes::zeros(size, 1, wraps);
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const int across = level ? y : x, along = level ? x : y;
      *out.at(x, y) = (across + along / part % 2 * 8) % 16 == 0 ? 1 : 0;
    }
  return out;
}

}  // namespace

TEST_CASE("changes across straight lines stay along half of the image, those across broken ones do not") {
  for (const bool level : {true, false}) {
    CAPTURE(level);
    for (const bool wraps : {true, false}) {
      const LineChanges straight = line_changes(lines({64, 64}, level, 64, wraps), level, 64, {});
      CHECK(straight.single > 0);
      CHECK(straight.brief == doctest::Approx(straight.single));
      CHECK(straight.lasting == doctest::Approx(straight.single));
    }
    const LineChanges broken = line_changes(lines({64, 64}, level, 16), level, 64, {});
    CHECK(broken.single == doctest::Approx(line_changes(lines({64, 64}, level, 64), level, 64, {}).single));
    CHECK(broken.lasting < 0.6 * broken.single);
    CHECK(line_changes(lines({64, 64}, level, 64), !level, 64, {}).single == 0);
  }
}

TEST_CASE("lines shorter than half the side that they are measured by have no changes") {
  CHECK(line_changes(lines({20, 64}, true, 64), true, 64, {}).single == 0);
  CHECK(line_changes(lines({20, 64}, false, 64), false, 64, {}).single > 0);
  CHECK(line_changes(lines({64, 1}, true, 64, false), true, 64, {}).single == 0);
}
