#include "core/filter/exemplar_faults.h"

#include <cmath>
#include <functional>

#include <doctest/doctest.h>

#include "core/base/hash.h"

using namespace terrazzo;

namespace {

ExemplarFaults faults_of(const std::function<double(int, int)>& value, Size size = {96, 64}) {
  std::vector<float> pixels;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++)
      for (int c = 0; c < 3; c++) pixels.push_back(float(value(x, y)));
  return exemplar_faults(*Image::from_floats({.size = size, .channels = 3}, std::move(pixels)));
}

double noise(int x, int y) {
  return double(random_bits(1, uint64_t(x), uint64_t(y), 0) % 1000) / 1000;
}

}  // namespace

TEST_CASE("an evenly lit texture has no faults") {
  const ExemplarFaults found = faults_of([](int x, int y) { return 0.3 + 0.4 * noise(x, y); });
  CHECK(found.one_colour < 0.1);
  CHECK(found.brightening < 0.1);
  CHECK_FALSE(found.is_mostly_one_colour());
  CHECK_FALSE(found.is_lit_from_a_side());
}

TEST_CASE("a background is found") {
  const ExemplarFaults found = faults_of([](int x, int y) { return x < 70 ? 1.0 : noise(x, y); });
  CHECK(found.one_colour == doctest::Approx(70.0 / 96).epsilon(0.02));
  CHECK(found.is_mostly_one_colour());
}

TEST_CASE("light from a side is found, and from which") {
  const ExemplarFaults left = faults_of([](int x, int y) { return (0.2 + 0.2 * noise(x, y)) * (1.6 - 0.6 * x / 95); });
  CHECK(left.is_lit_from_a_side());
  CHECK(left.bright_side == "left");
  CHECK(left.dark_side == "right");
  CHECK(left.brightening == doctest::Approx(0.55).epsilon(0.15));
  const ExemplarFaults below = faults_of([](int x, int y) { return (0.2 + 0.2 * noise(x, y)) * (1 + 0.8 * y / 63); });
  CHECK(below.bright_side == "bottom");
}

TEST_CASE("what a texture does itself is no light") {
  CHECK_FALSE(faults_of([](int x, int) { return x / 24 % 2 ? 0.8 : 0.2; }).is_lit_from_a_side());
  CHECK_FALSE(faults_of([](int x, int y) { return x < 32 && y < 32 ? 0.9 : 0.3; }).is_lit_from_a_side());
  CHECK(faults_of([](int, int) { return 0.0; }).brightening == 0);
  CHECK(faults_of([](int, int) { return 0.5; }, {4, 4}).one_colour == 0);
}
