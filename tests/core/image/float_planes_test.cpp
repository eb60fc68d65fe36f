#include "core/image/float_planes.h"

#include <numeric>

#include <doctest/doctest.h>

#include "tests/core/metrics/textures.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

double sum(const Planes& p) {
  return std::accumulate(p.values.begin(), p.values.end(), 0.0);
}

}  // namespace

TEST_CASE("a blur keeps the sum, even where it is wider than the image") {
  const Planes image = bricks({20, 12}, 1);
  CHECK(sum(blurred(image, 1.5)) == doctest::Approx(sum(image)).epsilon(1e-5));
  const Planes wide = blurred(image, 40);
  CHECK(sum(wide) == doctest::Approx(sum(image)).epsilon(1e-5));
  CHECK(channel_statistics(wide).deviation[0] < 0.01);
}

TEST_CASE("a blurred point is the Gaussian") {
  Planes point = Planes::zeros({31, 31}, 2);
  point.pixel(15, 15)[1] = 1;
  const Planes out = blurred(point, 2);
  CHECK(out.pixel(15, 15)[0] == 0);
  CHECK(out.pixel(15, 15)[1] == doctest::Approx(0.0397887).epsilon(1e-3));
  CHECK(out.pixel(17, 15)[1] / out.pixel(15, 15)[1] == doctest::Approx(0.6065307).epsilon(1e-5));
  CHECK(out.pixel(15, 18)[1] / out.pixel(15, 15)[1] == doctest::Approx(0.3246525).epsilon(1e-5));
}

TEST_CASE("a pyramid halves its levels, rounding up") {
  const auto levels = gaussian_pyramid(bricks({37, 20}, 1), 3);
  REQUIRE(levels.size() == 3);
  CHECK(levels[1].size == Size{19, 10});
  CHECK(levels[2].size == Size{10, 5});
}

TEST_CASE("shrinking by a whole factor gives the mean of each block, and growing a ramp keeps it a ramp") {
  Planes ramp = Planes::zeros({8, 4}, 1);
  for (int y = 0; y < 4; y++)
    for (int x = 0; x < 8; x++) ramp.pixel(x, y)[0] = float(x);
  const Planes half = resampled(ramp, {4, 2}), twice = resampled(ramp, {16, 8});
  for (int x = 0; x < 4; x++) CHECK(half.pixel(x, 1)[0] == doctest::Approx(2 * x + 0.5));
  for (int x = 1; x < 15; x++) CHECK(twice.pixel(x, 3)[0] == doctest::Approx(x / 2.0 - 0.25));
  CHECK(resampled(ramp, {5, 3}).pixel(2, 1)[0] == doctest::Approx(3.5));
}
