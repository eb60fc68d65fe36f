#include "core/numeric/principal_components.h"

#include <cmath>

#include <doctest/doctest.h>

#include "core/base/hash.h"

using namespace terrazzo;

TEST_CASE("the components of a stretched cloud are its axes, in order, with their variances") {
  // Along (3, 4, 0) / 5 with deviation 4, along (0, 0, 1) with deviation 1, flat otherwise.
  std::vector<float> samples;
  for (int i = 0; i < 4000; i++) {
    const double a = 8 * std::sqrt(3) * (unit_double(random_bits(1, i)) - 0.5);
    const double b = 2 * std::sqrt(3) * (unit_double(random_bits(2, i)) - 0.5);
    for (const double v : {0.6 * a + 7, 0.8 * a, b - 2}) samples.push_back(float(v));
  }
  const PrincipalComponents p = principal_components(samples, 3, 2);
  REQUIRE(p.variances.size() == 2);
  CHECK(p.variances[0] == doctest::Approx(16).epsilon(0.05));
  CHECK(p.variances[1] == doctest::Approx(1).epsilon(0.05));
  CHECK(p.total_variance == doctest::Approx(p.variances[0] + p.variances[1]).epsilon(1e-4));
  CHECK(p.components[0] == doctest::Approx(0.6).epsilon(0.02));
  CHECK(p.components[1] == doctest::Approx(0.8).epsilon(0.02));
  CHECK(p.components[5] == doctest::Approx(1).epsilon(0.02));
  CHECK(p.mean[0] == doctest::Approx(7).epsilon(0.05));
}

TEST_CASE("constant samples give orthonormal components of no variance") {
  const PrincipalComponents p = principal_components(std::vector<float>(300, 0.25f), 10, 4);
  for (int r = 0; r < 4; r++)
    for (int q = 0; q < 4; q++) {
      double dot = 0;
      for (int i = 0; i < 10; i++) dot += double(p.components[r * 10 + i]) * p.components[q * 10 + i];
      CHECK(dot == doctest::Approx(r == q ? 1 : 0).epsilon(1e-5));
    }
  CHECK(p.total_variance == doctest::Approx(0));
}
