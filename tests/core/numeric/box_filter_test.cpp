#include "core/numeric/box_filter.h"

#include <cstdlib>

#include <doctest/doctest.h>

using namespace terrazzo;

TEST_CASE("the local mean of a single bright pixel is a pyramid of the radius asked for") {
  std::vector<float> pixels(size_t(11) * 11 * 2);
  pixels[(5 * 11 + 5) * 2 + 1] = 1;
  const std::vector<float> mean = local_mean(pixels, {11, 11}, 2, 2, false);
  const double along[] = {1.0 / 9, 2.0 / 9, 3.0 / 9, 2.0 / 9, 1.0 / 9};
  for (int y = 0; y < 11; y++)
    for (int x = 0; x < 11; x++) {
      const bool within = std::abs(x - 5) <= 2 && std::abs(y - 5) <= 2;
      CHECK(mean[(y * 11 + x) * 2] == 0);
      CHECK(mean[(y * 11 + x) * 2 + 1] == doctest::Approx(within ? along[x - 3] * along[y - 3] : 0));
    }
}

TEST_CASE("beyond a border lies the other side, or more of the border") {
  const std::vector<float> row = {9, 0, 0, 0, 0, 0, 0, 0};
  CHECK(local_mean(row, {8, 1}, 1, 2, true)[7] == doctest::Approx(2));
  CHECK(local_mean(row, {8, 1}, 1, 2, false)[7] == 0);
  CHECK(local_mean(row, {8, 1}, 1, 2, false)[0] == doctest::Approx(5));
  const std::vector<float> flat(25, 0.5f);
  for (const float v : local_mean(flat, {5, 5}, 1, 9, false)) CHECK(v == doctest::Approx(0.5));
}
