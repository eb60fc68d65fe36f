#include "core/image/float_planes.h"

#include <cmath>
#include <numeric>

#include <doctest/doctest.h>

#include "tests/core/metrics/textures.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

double sum(const Planes& p) {
  return std::accumulate(p.values.begin(), p.values.end(), 0.0);
}

Planes impulse(Size size, int x, int y, bool wraps) {
  Planes p = Planes::zeros(size, 1, wraps);
  *p.at(x, y) = 1;
  return p;
}

}  // namespace

TEST_CASE("a blur keeps the sum, even where it is wider than the image") {
  const Planes image = bricks({20, 12}, 1);
  CHECK(sum(blurred(image, 1.5, Beyond::mirrored, Task())) == doctest::Approx(sum(image)).epsilon(1e-5));
  const Planes wide = blurred(image, 40, Beyond::mirrored, Task());
  CHECK(sum(wide) == doctest::Approx(sum(image)).epsilon(1e-5));
  CHECK(channel_moments(wide).variance(0) < 1e-4);
}

TEST_CASE("a blurred point is the Gaussian") {
  Planes point = Planes::zeros({31, 31}, 2);
  point.at(15, 15)[1] = 1;
  const Planes out = blurred(point, 2, Beyond::mirrored, Task());
  CHECK(out.at(15, 15)[0] == 0);
  CHECK(out.at(15, 15)[1] == doctest::Approx(0.0397887).epsilon(1e-3));
  CHECK(out.at(17, 15)[1] / out.at(15, 15)[1] == doctest::Approx(0.6065307).epsilon(1e-5));
  CHECK(out.at(15, 18)[1] / out.at(15, 15)[1] == doctest::Approx(0.3246525).epsilon(1e-5));
}

TEST_CASE("a blur goes around the borders of planes that wrap, and goes on with the border's pixels of others") {
  const Planes around = blurred(impulse({16, 9}, 0, 4, true), 1, Beyond::as_it_wraps, Task());
  CHECK(around.wraps);
  CHECK(*around.at(15, 4) == doctest::Approx(*around.at(1, 4)));
  CHECK(*around.at(15, 4) > 0.01);
  const Planes beyond = blurred(impulse({16, 9}, 0, 4, false), 1, Beyond::as_it_wraps, Task());
  CHECK(*beyond.at(15, 4) == 0);
  // The border pixel stands for all that lie beyond it: half of the Gaussian, and half of its middle weight.
  CHECK(*beyond.at(0, 4) / *around.at(0, 4) == doctest::Approx((0.5 + 0.1995) / 0.399).epsilon(0.01));
  CHECK(blurred(around, 0, Beyond::mirrored, Task()).values == around.values);
}

TEST_CASE("a box blur keeps the sum and has the variance asked for") {
  for (const double deviation : {0.4, 1.0, 3.3, 9.0}) {
    const Planes out = box_blurred(impulse({81, 81}, 40, 40, false), deviation, {});
    double variance = 0;
    for (int y = 0; y < 81; y++)
      for (int x = 0; x < 81; x++) variance += double(*out.at(x, y)) * (x - 40) * (x - 40);
    CAPTURE(deviation);
    CHECK(sum(out) == doctest::Approx(1).epsilon(1e-5));
    CHECK(std::sqrt(variance) == doctest::Approx(deviation).epsilon(1e-4));
  }
}

TEST_CASE("a box blur goes around the borders of planes that wrap, however wide it is") {
  const Planes middle = box_blurred(impulse({9, 7}, 4, 3, true), 5, {});
  const Planes corner = box_blurred(impulse({9, 7}, 0, 0, true), 5, {});
  for (int y = 0; y < 7; y++)
    for (int x = 0; x < 9; x++)
      CHECK(*corner.at(x, y) == doctest::Approx(*middle.at(wrap(x + 4, 9), wrap(y + 3, 7))).epsilon(1e-5));
  const Planes flat{{5, 4}, 2, false, std::vector<float>(40, 0.25f)};
  for (const float v : box_blurred(flat, 30, {}).values) CHECK(v == doctest::Approx(0.25));
}

TEST_CASE("a pyramid halves its levels, rounding up") {
  const auto levels = gaussian_pyramid(bricks({37, 20}, 1), 3, Task());
  REQUIRE(levels.size() == 3);
  CHECK(levels[1].size == Size{19, 10});
  CHECK(levels[2].size == Size{10, 5});
}

TEST_CASE("a pyramid of an image that tiles is the same wherever the image begins, as long as its sides are even") {
  Planes tile = bricks({36, 40}, 1), moved = Planes::zeros(tile.size, 1, true);
  tile.wraps = true;
  for (int y = 0; y < 40; y++)
    for (int x = 0; x < 36; x++) moved.at(x, y)[0] = tile.at(wrap(x + 16, 36), wrap(y + 8, 40))[0];
  const auto a = gaussian_pyramid(tile, 4, Task()), b = gaussian_pyramid(moved, 4, Task());
  for (int level = 0; level < 3; level++) {
    const Size size = a[level].size;
    CHECK(a[level].wraps);
    for (int y = 0; y < size.height; y++)
      for (int x = 0; x < size.width; x++)
        CHECK(*b[level].at(x, y) ==
              doctest::Approx(*a[level].at(wrap(x + (16 >> level), size.width), wrap(y + (8 >> level), size.height))));
  }
  CHECK_FALSE(a[3].wraps);
}

TEST_CASE("shrinking by a whole factor gives the mean of each block, and growing a ramp keeps it a ramp") {
  Planes ramp = Planes::zeros({8, 4}, 1);
  for (int y = 0; y < 4; y++)
    for (int x = 0; x < 8; x++) ramp.at(x, y)[0] = float(x);
  const Planes half = resampled(ramp, {4, 2}), twice = resampled(ramp, {16, 8});
  for (int x = 0; x < 4; x++) CHECK(half.at(x, 1)[0] == doctest::Approx(2 * x + 0.5));
  for (int x = 1; x < 15; x++) CHECK(twice.at(x, 3)[0] == doctest::Approx(x / 2.0 - 0.25));
  CHECK(resampled(ramp, {5, 3}).at(2, 1)[0] == doctest::Approx(3.5));
}
