#include <cmath>
#include <numeric>

#include <doctest/doctest.h>

#include "core/image/normal.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("blur turns an impulse into the Gaussian") {
  const double sigma = 2;
  const ImagePtr impulse = make_image({33, 33}, 1, [](int x, int y, int) { return float(x == 16 && y == 16); });
  const std::vector<float> p = run_image("blur", {{"radius", sigma}}, {{"image", impulse}})->pixels();
  const double pi = 3.14159265358979;
  for (int y = 0; y < 33; y++)
    for (int x = 0; x < 33; x++) {
      const double r2 = (x - 16.0) * (x - 16) + (y - 16.0) * (y - 16);
      CHECK(std::fabs(p[y * 33 + x] - std::exp(-r2 / (2 * sigma * sigma)) / (2 * pi * sigma * sigma)) < 4e-4);
    }
}

TEST_CASE("blur keeps the mean of an image that wraps, at any radius") {
  const ImagePtr image = noise_image({24, 16}, 1);
  const std::vector<float> before = image->pixels();
  for (const double radius : {0.3, 3.0, 30.0}) {
    const std::vector<float> after =
        run_image("blur", {{"radius", radius}, {"edges", "wrap"}}, {{"image", image}})->pixels();
    CHECK(std::accumulate(after.begin(), after.end(), 0.0) ==
          doctest::Approx(std::accumulate(before.begin(), before.end(), 0.0)).epsilon(1e-5));
  }
}

TEST_CASE("blur of radius 0 leaves every bit") {
  const ImagePtr image = noise_image({9, 9}, 3, Semantic::base_color, "srgb_texture");
  CHECK(run_image("blur", {{"radius", 0.0}}, {{"image", image}})->pixels() == image->pixels());
}

TEST_CASE("blur is the same in tiles and as a whole, small and large") {
  for (const double radius : {1.5, 9.0})
    for (const std::string edges : {"clamp", "wrap"})
      check_every_size([&](Size size) {
        return run_image("blur", {{"radius", radius}, {"edges", edges}},
                         {{"image", noise_image(size, 3, Semantic::base_color, "srgb_texture")}});
      });
}

TEST_CASE("a blur that keeps its rows gives what one that does not would") {
  const ImagePtr image = noise_image({40, 30}, 1);
  const ImagePtr below = run_image("blur", {{"radius", 7.9999}}, {{"image", image}});
  const ImagePtr above = run_image("blur", {{"radius", 8.0}}, {{"image", image}});
  CHECK(greatest_difference(*below, *above) < 1e-4);
}

TEST_CASE("blurred normals have unit length") {
  const std::vector<float> p =
      run_image("blur", {{"radius", 1.0}}, {{"image", noise_image({12, 12}, 3, Semantic::normal)}})->pixels();
  for (size_t i = 0; i < p.size(); i += 3) {
    const Vector3f n = decode_normal(&p[i], NormalY::up);
    CHECK(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] == doctest::Approx(1).epsilon(1e-4));
  }
}
