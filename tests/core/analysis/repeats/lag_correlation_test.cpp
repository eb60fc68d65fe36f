#include "core/analysis/repeats/lag_correlation.h"

#include <doctest/doctest.h>

#include "core/base/hash.h"

using namespace terrazzo;

namespace {

Correlation correlation_of(Size size, uint64_t seed) {
  Planes planes{size, 1, false, {}};
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++)
      planes.values.push_back(float(y % 9 < 2) + float(unit_double(random_bits(seed, x, y))));
  return correlate(planes, {}, Task());
}

}  // namespace

TEST_CASE("one correlation pooled is itself, and one pooled with itself too") {
  const Correlation r = correlation_of({40, 60}, 1);
  const Correlation one = pooled({r}), twice = pooled({r, r});
  for (const auto& [dx, dy] : {std::pair(0, 0), {3, 9}, {20, -33}, {32, 49}}) {
    CHECK(one.at(dx, dy) == r.at(dx, dy));
    CHECK(twice.at(dx, dy) == doctest::Approx(r.at(dx, dy)));
  }
  CHECK(twice.covers(5, 5) == r.covers(5, 5));
}

TEST_CASE("pooled correlations count by how much lies on itself, and reach as far as the farthest") {
  const Correlation wide = correlation_of({80, 40}, 1), high = correlation_of({40, 80}, 2);
  const Correlation both = pooled({wide, high});
  CHECK(both.at(0, 0) == doctest::Approx(1));
  const double in_wide = (80.0 - 7) * (40 - 9), in_high = (40.0 - 7) * (80 - 9);
  CHECK(both.at(7, 9) == doctest::Approx((in_wide * wide.at(7, 9) + in_high * high.at(7, 9)) / (in_wide + in_high)));
  CHECK(both.at(60, 4) == doctest::Approx(wide.at(60, 4)));
  CHECK(both.at(4, 60) == doctest::Approx(high.at(4, 60)));
  CHECK(both.at(60, 60) == 0);
  CHECK_FALSE(both.covers(60, 60));
}
