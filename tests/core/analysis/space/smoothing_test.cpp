#include "core/analysis/space/smoothing.h"

#include <cmath>

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include "core/base/hash.h"

using namespace terrazzo;

namespace {

ExemplarPlanes impulse(Size size, int x, int y, bool wraps) {
  ExemplarPlanes p{size, 1, wraps, std::vector<float>(size_t(size.area()))};
  *p.at(x, y) = 1;
  return p;
}

}  // namespace

TEST_CASE("box smoothing keeps the sum and has the variance asked for") {
  for (const double deviation : {0.4, 1.0, 3.3, 9.0}) {
    const ExemplarPlanes out = box_smoothed(impulse({81, 81}, 40, 40, false), deviation, {});
    double sum = 0, variance = 0;
    for (int y = 0; y < 81; y++)
      for (int x = 0; x < 81; x++) {
        sum += double(*out.at(x, y));
        variance += double(*out.at(x, y)) * (x - 40) * (x - 40);
      }
    CAPTURE(deviation);
    CHECK(sum == doctest::Approx(1).epsilon(1e-5));
    CHECK(std::sqrt(variance) == doctest::Approx(deviation).epsilon(1e-4));
  }
}

TEST_CASE("smoothing goes around the borders of planes that wrap, however wide it is") {
  const ExemplarPlanes middle = box_smoothed(impulse({9, 7}, 4, 3, true), 5, {});
  const ExemplarPlanes corner = box_smoothed(impulse({9, 7}, 0, 0, true), 5, {});
  for (int y = 0; y < 7; y++)
    for (int x = 0; x < 9; x++)
      CHECK(*corner.at(x, y) == doctest::Approx(*middle.at(wrap(x + 4, 9), wrap(y + 3, 7))).epsilon(1e-5));
  ExemplarPlanes flat{{5, 4}, 2, false, std::vector<float>(40, 0.25f)};
  for (const float v : box_smoothed(flat, 30, {}).values) CHECK(v == doctest::Approx(0.25));
}
