#include <cmath>

#include <doctest/doctest.h>

#include "core/image/normal.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr Size size{61, 61};

ImagePtr heights(const std::function<double(double x, double y)>& height) {
  return make_image(
      size, 1, [&](int x, int y, int) { return float(height(x - 30, y - 30)); }, Semantic::height);
}

ImagePtr normals(NormalY normal_y, const std::function<Vector3f(float x, float y)>& normal) {
  ImageInfo info{.size = size, .channels = 3, .semantic = Semantic::normal};
  info.normal_y = normal_y;
  std::vector<float> pixels(size_t(size.area()) * 3);
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++)
      encode_normal(normal(float(x - 30), float(30 - y)), normal_y, &pixels[size_t(y * size.width + x) * 3]);
  return Image::from_floats(info, std::move(pixels));
}

/// Heights count in pixels.
ImagePtr curvature(const ImagePtr& image, Params params = {}) {
  params.emplace("height_scale", 1.0);
  return run_image("make_curvature", params, {{"image", image}});
}

float middle(const ImagePtr& image) {
  return image->read({30, 30, 1, 1}).front();
}

}  // namespace

TEST_CASE("a plane has no curvature, level or tilted, up to its borders") {
  const ImagePtr level = curvature(heights([](double, double) { return 0.3; }));
  CHECK(level->info().semantic == Semantic::data);
  for (const float v : level->pixels()) CHECK(v == 0.5f);
  for (const float v : curvature(heights([](double x, double y) { return 0.25 * x - 0.5 * y; }))->pixels())
    CHECK(v == doctest::Approx(0.5).epsilon(1e-5));
}

TEST_CASE("of a cylinder of radius R the mean curvature is 1 / 2R, everywhere on its normals") {
  const float radius = 100;
  for (const NormalY normal_y : {NormalY::up, NormalY::down}) {
    const ImagePtr along_y = curvature(normals(
        normal_y, [&](float x, float) { return Vector3f(x / radius, 0, std::sqrt(1 - x * x / radius / radius)); }));
    const ImagePtr along_x = curvature(normals(
        normal_y, [&](float, float y) { return Vector3f(0, y / radius, std::sqrt(1 - y * y / radius / radius)); }));
    // The default radius is 2.
    for (const ImagePtr& image : {along_x, along_y})
      for (const float v : image->pixels()) CHECK(v - 0.5f == doctest::Approx(2 / (2 * radius)).epsilon(1e-3));
  }
}

TEST_CASE("of a cylinder's heights as well, and twice as much of a sphere") {
  const double radius = 100;
  const auto circle = [&](double r2) { return std::sqrt(radius * radius - r2); };
  const Params params{{"strength", 4.0}};
  const ImagePtr cylinder = curvature(heights([&](double x, double) { return circle(x * x); }), params);
  const ImagePtr sphere = curvature(heights([&](double x, double y) { return circle(x * x + y * y); }), params);
  const ImagePtr pit = curvature(heights([&](double x, double y) { return -circle(x * x + y * y); }), params);
  for (const Rect& r : {Rect{30, 30, 1, 1}, Rect{15, 40, 1, 1}, Rect{45, 10, 1, 1}}) {
    CHECK(cylinder->read(r).front() - 0.5f == doctest::Approx(4 * 2 / (2 * radius)).epsilon(0.005));
    CHECK(sphere->read(r).front() - 0.5f == doctest::Approx(4 * 2 / radius).epsilon(0.005));
    CHECK(0.5f - pit->read(r).front() == doctest::Approx(4 * 2 / radius).epsilon(0.005));
  }
}

TEST_CASE("of a paraboloid z = (a x^2 + b y^2) / 2 the curvature at the top is -(a + b) / 2; a saddle is flat") {
  const auto at_top = [](double a, double b) {
    return middle(curvature(heights([&](double x, double y) { return (a * x * x + b * y * y) / 2; }),
                            {{"radius", 1.0}, {"strength", 10.0}}));
  };
  CHECK(at_top(-0.02, -0.01) == doctest::Approx(0.5 + 10 * 0.015).epsilon(0.002));
  CHECK(at_top(0.02, 0.01) == doctest::Approx(0.5 - 10 * 0.015).epsilon(0.002));
  CHECK(at_top(0.02, -0.02) == doctest::Approx(0.5).epsilon(1e-4));
}

TEST_CASE("convex keeps ridges, concave grooves, with twice the contrast") {
  for (const double sign : {1.0, -1.0}) {
    const ImagePtr height = heights([&](double x, double) { return -sign * x * x / 50; });
    const float both = middle(curvature(height));
    const float convex = middle(curvature(height, {{"shape", "convex"}}));
    const float concave = middle(curvature(height, {{"shape", "concave"}}));
    CHECK((sign > 0 ? convex : concave) == doctest::Approx(2 * std::abs(both - 0.5)).epsilon(1e-4));
    CHECK((sign > 0 ? concave : convex) == 0);
  }
}

TEST_CASE("a sharp ridge looks alike at every radius") {
  const ImagePtr ridge = heights([](double x, double) { return -std::abs(x); });
  const float fine = middle(curvature(ridge, {{"radius", 3.0}})), broad = middle(curvature(ridge, {{"radius", 8.0}}));
  // Normals turn by 2 sin 45 degrees: half of that times the Gaussian's peak, 1 / sqrt(2 pi).
  CHECK(fine - 0.5f == doctest::Approx(0.70711 * 0.39894).epsilon(0.05));
  CHECK(broad - 0.5f == doctest::Approx(0.70711 * 0.39894).epsilon(0.05));
}

TEST_CASE("make_curvature is the same in tiles and as a whole") {
  for (const std::string edges : {"clamp", "wrap"})
    check_every_size([&](Size s) { return curvature(noise_image(s, 1, Semantic::height), {{"edges", edges}}); });
  check_every_size([&](Size s) { return curvature(noise_image(s, 3, Semantic::normal)); });
}

TEST_CASE("make_curvature wants heights or normals") {
  CHECK(error_of("make_curvature", {}, {{"image", flat_image({4, 2}, {0, 0, 0}, Semantic::base_color)}}, "image")
            .find("expected a height map of 1 channel or a normal map of 3 channels, found a base_color map") !=
        std::string::npos);
}
