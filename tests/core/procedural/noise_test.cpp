#include "core/procedural/noise.h"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

using namespace terrazzo;

namespace {

using Noise = double (*)(double, double, uint64_t, Period);

double plain_cells(double x, double y, uint64_t seed, Period period) {
  return cell_noise(x, y, seed, period).nearest;
}

}  // namespace

TEST_CASE("lattice noises repeat after their period and not before") {
  for (const Noise noise : {value_noise, gradient_noise, simplex_noise, plain_cells}) {
    const Period period{3, 4};
    double moved = 0;
    for (double t = 0.05; t < 3; t += 0.31) {
      const double here = noise(t, 2.3 - t, 5, period);
      CHECK(noise(t + 3, 2.3 - t, 5, period) == doctest::Approx(here).epsilon(1e-9));
      CHECK(noise(t, 2.3 - t + 4, 5, period) == doctest::Approx(here).epsilon(1e-9));
      CHECK(noise(t - 3, 2.3 - t - 8, 5, period) == doctest::Approx(here).epsilon(1e-9));
      moved += std::abs(noise(t + 1, 2.3 - t, 5, period) - here);
    }
    CHECK(moved > 0.2);
  }
}

TEST_CASE("lattice noises are continuous, stay in range and use it") {
  for (const Noise noise : {value_noise, gradient_noise, simplex_noise}) {
    double low = 1, high = -1, jump = 0;
    for (double y = 0; y < 30; y += 0.37) {
      double before = noise(0, y, 1, {});
      for (double x = 0.01; x < 5; x += 0.01) {
        const double n = noise(x, y, 1, {});
        low = std::min(low, n);
        high = std::max(high, n);
        jump = std::max(jump, std::abs(n - before));
        before = n;
      }
    }
    CHECK(low >= -1);
    CHECK(high <= 1);
    CHECK(low < -0.6);
    CHECK(high > 0.6);
    CHECK(jump < 0.06);
  }
}

TEST_CASE("the nearest point is nearer than the second") {
  for (double x = -3; x < 3; x += 0.21) {
    const CellPoint p = cell_noise(x, x * 0.7, 9, {});
    CHECK(p.nearest <= p.second);
    CHECK(p.nearest == doctest::Approx(std::sqrt(p.dx * p.dx + p.dy * p.dy)));
  }
}
