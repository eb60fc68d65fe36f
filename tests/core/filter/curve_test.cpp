#include "core/filter/curve.h"

#include <limits>

#include <doctest/doctest.h>

using namespace terrazzo;

TEST_CASE("a curve goes through its points and is constant beyond them") {
  for (const bool smooth : {false, true}) {
    const Curve c({{0.1, 0.3}, {0.4, 0.2}, {0.5, 0.9}, {1, 0.6}}, smooth);
    CHECK(c.at(0.1) == doctest::Approx(0.3));
    CHECK(c.at(0.4) == doctest::Approx(0.2));
    CHECK(c.at(0.5) == doctest::Approx(0.9));
    CHECK(c.at(1) == doctest::Approx(0.6));
    CHECK(c.at(-5) == 0.3);
    CHECK(c.at(7) == 0.6);
    CHECK(c.at(std::numeric_limits<double>::quiet_NaN()) == 0.3);
    CHECK(Curve({{0.5, 0.25}}, smooth).at(0.9) == 0.25);
    CHECK(Curve({{0, 0}, {1, 1}}, smooth).at(0.3) == doctest::Approx(0.3));
  }
  CHECK(Curve({{0, 0}, {0.5, 1}, {1, 0}}, false).at(0.75) == doctest::Approx(0.5));
}

TEST_CASE("a smooth curve never overshoots, and has no corners between points that rise") {
  const Curve c({{0, 0}, {0.3, 0.05}, {0.5, 0.9}, {0.8, 0.9}, {1, 0.2}}, true);
  const auto monotone = [&](double from, double to, bool rises) {
    for (double x = from; x < to - 1e-3; x += 1e-3) {
      const double step = c.at(x + 1e-3) - c.at(x);
      CHECK((rises ? step >= -1e-12 : step <= 1e-12));
    }
  };
  monotone(0, 0.5, true);
  monotone(0.8, 1, false);
  for (double x = 0.5; x <= 0.8; x += 0.01) CHECK(c.at(x) == doctest::Approx(0.9));
  const double e = 1e-6;
  CHECK((c.at(0.3) - c.at(0.3 - e)) / e == doctest::Approx((c.at(0.3 + e) - c.at(0.3)) / e).epsilon(1e-3));
}
