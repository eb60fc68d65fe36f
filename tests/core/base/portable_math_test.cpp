#include "core/base/portable_math.h"

#include <cmath>

#include <doctest/doctest.h>

using namespace terrazzo;

TEST_CASE("exact elementary functions agree with the library's to nine digits") {
  for (double x = -8; x <= 8; x += 0.137) {
    CHECK(portable::exp2(x) == doctest::Approx(std::exp2(x)).epsilon(1e-9));
    CHECK(portable::exp(x) == doctest::Approx(std::exp(x)).epsilon(1e-9));
    CHECK(portable::log2(std::exp2(x)) == doctest::Approx(x).epsilon(1e-9));
    CHECK(portable::sin_turns(x) == doctest::Approx(std::sin(x * 6.283185307179586)).epsilon(1e-9));
    CHECK(portable::cos_turns(x) == doctest::Approx(std::cos(x * 6.283185307179586)).epsilon(1e-9));
  }
  for (double x = 0.003; x < 40; x *= 1.7)
    CHECK(portable::pow(x, 2.4) == doctest::Approx(std::pow(x, 2.4)).epsilon(1e-9));
  CHECK(portable::pow(0, 2.4) == 0);
  for (double x = 1e-30; x < 1e30; x *= 7.3) {
    CHECK(portable::root<3>(x) == doctest::Approx(std::cbrt(x)).epsilon(1e-9));
    CHECK(portable::root<5>(x) == doctest::Approx(std::pow(x, 0.2)).epsilon(1e-9));
  }
}

TEST_CASE("floor rounds down on both sides of zero") {
  CHECK(portable::floor_int(-0.5) == -1);
  CHECK(portable::floor_int(-2.0) == -2);
  CHECK(portable::floor_int(2.999) == 2);
}

TEST_CASE("a smoothstep runs either way") {
  CHECK(portable::smoothstep(0, 1, 0.5) == doctest::Approx(0.5));
  CHECK(portable::smoothstep(1, 0, -3) == 1);
  CHECK(portable::smoothstep(1, 0, 2) == 0);
}
