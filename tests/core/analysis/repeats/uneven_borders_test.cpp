#include "core/analysis/repeats/uneven_borders.h"

#include <cmath>

#include <doctest/doctest.h>

#include "core/base/hash.h"
#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// Grain of 160 by 128 pixels, darker by this much, in deviations of the grain, to the left of a column.
FeaturesPtr shaded_grain(int column, double darker, bool wraps = false) {
  return plain_features(
      make_image({160, 128}, 1,
                 [=](int x, int y, int) {
                   return float(unit_double(random_bits(5, x, y)) - (x < column ? darker * std::sqrt(1.0 / 12) : 0));
                 }),
      wraps);
}

}  // namespace

TEST_CASE("a border that is unlike all the rest of an exemplar that does not tile is told of") {
  const Rect all = whole({160, 128});
  const auto even = [](const FeaturesPtr& features) { return evenness(*features, Task()).part; };
  CHECK(even(shaded_grain(30, 2)) == Rect{30, 0, 130, 128});
  CHECK(even(shaded_grain(0, 0)) == all);
  // A joint along the border, and what is no border but half of the exemplar.
  CHECK(even(shaded_grain(8, 2)) == all);
  CHECK(even(shaded_grain(80, 2)) == all);
  CHECK(even(shaded_grain(30, 2, true)) == all);
}

TEST_CASE("where bands end a border may be left out, but not along them, as one may lie there") {
  const auto courses = [](double foot, double side) {
    return plain_features(make_image({160, 160}, 1, [=](int x, int y, int) {
      const double grain = 0.3 * unit_double(random_bits(5, x, y));
      return float(grain + (y % 20 < 3 ? 0 : 1) - (y >= 130 ? foot : 0) - (x >= 130 ? side : 0));
    }));
  };
  const auto even = [&](double foot, double side) {
    return evenness(*courses(foot, side)->with(Lattice{1, {0, 20}, {}, 1}), Task()).part;
  };
  CHECK(even(0, 0.5) == Rect{0, 0, 130, 160});
  CHECK(even(0.5, 0) == whole({160, 160}));
}

TEST_CASE("an exemplar that changes from one side to the other is told of, unless courses keep it in its place") {
  const auto slope = [](double by, bool spots) {
    return plain_features(make_image({160, 160}, 1, [=](int x, int y, int) {
      const double stain = spots ? std::hypot(x - 60.0, y - 90.0) < 40 : y / 160.0;
      return float(unit_double(random_bits(5, x, y)) + by * stain);
    }));
  };
  const auto changes = [](const FeaturesPtr& features) {
    const Evenness found = evenness(*features, Task());
    CHECK_FALSE(found.changes_across);
    return found.changes_down;
  };
  CHECK(changes(slope(0.6, false)));
  CHECK_FALSE(changes(slope(0.1, false)));
  CHECK_FALSE(changes(slope(0.6, true)));
  CHECK_FALSE(changes(slope(0.6, false)->with(Lattice{1, {0, 160}, {}, 1})));
  CHECK(changes(slope(0.6, false)->with(Lattice{1, {40, 0}, {}, 1})));
  CHECK(changes(slope(0.6, false)->with(Lattice{2, {40, 0}, {0, 20}, 1})));
  CHECK_FALSE(changes(slope(0.6, false)->with(Lattice{2, {40, 0}, {0, 160}, 1})));
}
