#include "core/base/portable_math.h"

#include <cmath>

#include <doctest/doctest.h>

using namespace terrazzo;

namespace {

constexpr long double pi = 3.14159265358979323846264338327950288L;

/// The greatest relative error that was seen; where the reference is below 1e-3, relative to that.
class Worst {
 public:
  void add(double value, long double reference) {
    const long double unit = std::max(std::fabs(reference), 1e-3L);
    worst_ = std::max(worst_, std::fabs(static_cast<long double>(value) - reference) / unit);
  }
  double error() const { return static_cast<double>(worst_); }

 private:
  long double worst_ = 0;
};

}  // namespace

TEST_CASE("powers and logarithms are as near to the long double's as the header says") {
  Worst exp2, exp, log2, log, pow;
  for (double x = -60; x <= 60; x += 0.00371) {
    exp2.add(portable::exp2(x), std::exp2(static_cast<long double>(x)));
    exp.add(portable::exp(x), std::exp(static_cast<long double>(x)));
    const double y = std::exp2(x);
    log2.add(portable::log2(y), std::log2(static_cast<long double>(y)));
    log.add(portable::log(y), std::log(static_cast<long double>(y)));
  }
  for (double x = 0.0031; x < 40; x *= 1.0137)
    for (const double p : {1 / 2.4, 0.5, 2.2, 2.4, 5.0})
      pow.add(portable::pow(x, p), std::pow(static_cast<long double>(x), static_cast<long double>(p)));
  CHECK(exp2.error() < 1e-10);
  CHECK(exp.error() < 1e-10);
  CHECK(log2.error() < 1e-11);
  CHECK(log.error() < 1e-11);
  CHECK(pow.error() < 1e-9);
  CHECK(portable::pow(0, 2.4) == 0);
  CHECK(portable::pow(0.5, 1e9) < 1e-300);
  CHECK(portable::log(1) == 0);
}

TEST_CASE("logarithms keep their digits next to 1") {
  for (const double d : {1e-3, 1e-6, 1e-9, -1e-3, -1e-6, -1e-9}) {
    const double x = 1 + d;
    CHECK(portable::log(x) ==
          doctest::Approx(static_cast<double>(std::log(static_cast<long double>(x)))).epsilon(1e-10));
  }
}

TEST_CASE("roots are as near to the long double's as the header says") {
  Worst third, fifth;
  for (double x = 1e-3; x < 1e30; x *= 1.37) {
    third.add(portable::root<3>(x), std::cbrt(static_cast<long double>(x)));
    fifth.add(portable::root<5>(x), std::pow(static_cast<long double>(x), 0.2L));
  }
  CHECK(third.error() < 1e-9);
  CHECK(fifth.error() < 1e-9);
}

TEST_CASE("sines and angles are as near to the long double's as the header says") {
  Worst sine, cosine, angle;
  for (double turns = -3; turns <= 3; turns += 0.00173) {
    sine.add(portable::sin_turns(turns), std::sin(turns * 2 * pi));
    cosine.add(portable::cos_turns(turns), std::cos(turns * 2 * pi));
    for (const double length : {1e-9, 1.0, 3e7}) {
      const double x = length * portable::cos_turns(turns), y = length * portable::sin_turns(turns);
      angle.add(portable::atan2(y, x), std::atan2(static_cast<long double>(y), static_cast<long double>(x)));
    }
  }
  CHECK(sine.error() < 1e-9);
  CHECK(cosine.error() < 1e-9);
  CHECK(angle.error() < 1e-9);
}

TEST_CASE("an angle has its sign and its quadrant") {
  const double half = static_cast<double>(pi) / 2;
  CHECK(portable::atan2(0, 0) == 0);
  CHECK(portable::atan2(0, 3) == 0);
  CHECK(portable::atan2(0, -3) == doctest::Approx(2 * half));
  CHECK(portable::atan2(2, 0) == doctest::Approx(half));
  CHECK(portable::atan2(-2, 0) == doctest::Approx(-half));
  CHECK(portable::atan2(-1, -1) == doctest::Approx(-1.5 * half));
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
