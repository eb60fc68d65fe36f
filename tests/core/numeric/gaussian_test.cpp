#include "core/numeric/gaussian.h"

#include <cmath>

#include <doctest/doctest.h>

using namespace terrazzo;

TEST_CASE("the normal quantile inverts the normal distribution function, far into its tails") {
  for (double x = -6.5; x <= 6.5; x += 0.01) {
    const double rank = 0.5 * std::erfc(-x / std::sqrt(2.0));
    // Close to 1 ranks themselves are known to 1e-16 only.
    const double known = x > 5 ? 1e-3 : 3e-7;
    REQUIRE(std::abs(normal_quantile(rank) - x) < known * std::max(1.0, std::abs(x)));
  }
  CHECK(normal_quantile(0.5) == 0);
  CHECK(normal_quantile(0.025) == doctest::Approx(-1.959963985));
}
