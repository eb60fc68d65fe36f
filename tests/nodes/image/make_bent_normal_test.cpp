#include <cmath>

#include <doctest/doctest.h>

#include "core/image/normal.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr double pi = 3.14159265358979324;

ImagePtr bent(const ImagePtr& height, Params params = {}) {
  params.emplace("height_scale", 1.0);
  return run_image("make_bent_normal", params, {{"height", height}});
}

Vector3f normal_at(const ImagePtr& image, int x, int y) {
  return decode_normal(image->read({x, y, 1, 1}).data(), image->info().normal_y);
}

double degrees(double radians) {
  return radians * 180 / pi;
}

/// How far a point at the distance 1 from a long wall of that height bends away, by fine sums over the sky.
double bend_beside_wall(double tall, bool uniform) {
  double out = 0, up = 0;
  constexpr int turns = 720, steps = 2000;
  for (int i = 0; i < turns; i++) {
    const double turn = 2 * pi * (i + 0.5) / turns, t = std::max(0.0, tall * std::cos(turn));
    const double horizon = t > 0 ? std::atan(1 / t) : pi / 2;
    for (int j = 0; j < steps; j++) {
      const double a = horizon * (j + 0.5) / steps;
      const double weight = horizon * std::sin(a) * (uniform ? 1 : std::cos(a));
      out -= weight * std::sin(a) * std::cos(turn);
      up += weight * std::cos(a);
    }
  }
  return degrees(std::atan2(out, up));
}

}  // namespace

TEST_CASE("over a flat plane bent normals point straight up") {
  const ImagePtr image = bent(flat_image({9, 7}, {0.3f}, Semantic::height));
  CHECK(image->info().semantic == Semantic::normal);
  const std::vector<float> p = image->pixels();
  for (size_t i = 0; i < p.size(); i += 3)
    CHECK(std::vector<float>(&p[i], &p[i] + 3) == std::vector<float>{0.5f, 0.5f, 1});
}

TEST_CASE("fine sums over the sky know the endless wall: 45 degrees, or by cosines atan(2 / pi)") {
  CHECK(bend_beside_wall(1e6, true) == doctest::Approx(45).epsilon(0.01));
  CHECK(bend_beside_wall(1e6, false) == doctest::Approx(degrees(std::atan(2 / pi))).epsilon(0.01));
}

TEST_CASE("beside a long wall bent normals lean away from it by the analytic angle") {
  const int distance = 16;
  for (const bool uniform : {false, true})
    for (const double tall : {0.5, 1.0, 2.0}) {
      CAPTURE(tall);
      const Params params{
          {"height_scale", tall * distance}, {"radius", int64_t{400}}, {"sky", uniform ? "uniform" : "cosine"}};
      const ImagePtr to_the_right = make_image(
          {60, 3}, 1, [&](int x, int, int) { return float(x >= 20 + distance); }, Semantic::height);
      const Vector3f n = normal_at(bent(to_the_right, params), 20, 1);
      CHECK(n.y() == doctest::Approx(0).epsilon(1e-4));
      CHECK(std::abs(degrees(std::atan2(-n.x(), n.z())) - bend_beside_wall(tall, uniform)) < 0.2);

      const ImagePtr below = make_image(
          {3, 60}, 1, [&](int, int y, int) { return float(y >= 20 + distance); }, Semantic::height);
      for (const std::string normal_y : {"up", "down"}) {
        Params with_y = params;
        with_y["normal_y"] = normal_y;
        const Vector3f m = normal_at(bent(below, with_y), 1, 20);
        CHECK(m.x() == doctest::Approx(0).epsilon(1e-4));
        CHECK(m.y() == doctest::Approx(-n.x()).epsilon(1e-4));
      }
    }
}

TEST_CASE("in the middle of a V groove they stay upright, and on its sides lean to the middle") {
  const ImagePtr groove = make_image(
      {41, 41}, 1, [](int x, int, int) { return float(std::abs(x - 20)); }, Semantic::height);
  const ImagePtr image = bent(groove, {{"radius", int64_t{20}}});
  CHECK(normal_at(image, 20, 20).x() == doctest::Approx(0).epsilon(1e-5));
  CHECK(normal_at(image, 20, 20).z() == doctest::Approx(1));
  CHECK(normal_at(image, 14, 20).x() > 0.1f);
  CHECK(normal_at(image, 26, 20).x() == doctest::Approx(-normal_at(image, 14, 20).x()).epsilon(1e-4));
}

TEST_CASE("bent normals are unit vectors, the same on any number of threads") {
  check_every_size([](Size size) {
    const ImagePtr image = bent(noise_image(size, 1, Semantic::height),
                                {{"radius", int64_t{9}}, {"edges", "wrap"}, {"height_scale", 9.0}});
    for (int x = 0; x < size.width; x++) CHECK(normal_at(image, x, 0).norm() == doctest::Approx(1).epsilon(1e-5));
    return image;
  });
}

TEST_CASE("make_bent_normal wants one channel") {
  CHECK(error_of("make_bent_normal", {}, {{"height", flat_image({2, 2}, {0, 0})}}, "height").find("2 channels") !=
        std::string::npos);
}
