#include "core/filter/height_from_normals.h"

#include <cmath>

#include <doctest/doctest.h>

#include "core/numeric/linear_algebra.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr double pi = 3.14159265358979324;
using Slope = std::function<Vector2d(int x, int y)>;  ///< rise per pixel to the right and down

/// The exact normals of slopes, as floats.
ImagePtr normals_of(Size size, const Slope& slope) {
  ImageInfo info{.size = size, .channels = 3, .semantic = Semantic::normal};
  std::vector<float> pixels(size_t(size.area()) * 3);
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const Vector2d s = slope(x, y);
      encode_normal(normalized(Vector3f(float(-s.x()), float(s.y()), 1)), NormalY::up,
                    &pixels[(size_t(y) * size_t(size.width) + size_t(x)) * 3]);
    }
  return Image::from_floats(info, std::move(pixels));
}

/// The largest difference to a surface of mean 0 after `flatten`, `filter`, `outside`.
double error_of(const ImagePtr& normals, const IntegrationOptions& options,
                const std::function<double(int x, int y)>& expected) {
  const std::vector<float> found = heights_from_normals(*normals, options, {});
  const Size size = normals->size();
  std::vector<double> wanted;
  double mean = 0;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      wanted.push_back(expected(x, y));
      mean += wanted.back() / double(size.area());
    }
  double worst = 0;
  for (size_t i = 0; i < found.size(); i++) worst = std::max(worst, std::abs(found[i] - (wanted[i] - mean)));
  return worst;
}

const IntegrationOptions exact_wrapped{.filter = std::nullopt, .outside = Outside::wrap};
const IntegrationOptions exact_clamped{.filter = std::nullopt, .outside = Outside::clamp};

}  // namespace

TEST_CASE("the normals of a wave give the wave") {
  const double w = 2 * pi / 32, v = 2 * pi / 48, tall = 5;
  const auto wave = [&](int x, int y) { return tall * std::sin(w * x) * std::cos(v * y); };
  const ImagePtr normals = normals_of({96, 96}, [&](int x, int y) {
    return Vector2d(tall * w * std::cos(w * x) * std::cos(v * y), -tall * v * std::sin(w * x) * std::sin(v * y));
  });
  CHECK(error_of(normals, exact_wrapped, wave) < 2e-4 * tall);
  CHECK(error_of(normals, exact_clamped, wave) < 1e-3 * tall);
}

TEST_CASE("a ramp stays a ramp up to borders that clamp, whether its border slopes are whole or halved") {
  const Vector2d slope(0.5, -0.2);
  const auto ramp = [&](int x, int y) { return slope.x() * x + slope.y() * y; };
  const ImagePtr whole_slopes = normals_of({61, 40}, [&](int, int) { return slope; });
  const ImagePtr halved = normals_of({61, 40}, [&](int x, int y) {
    return Vector2d(slope.x() * (x % 60 == 0 ? 0.5 : 1), slope.y() * (y % 39 == 0 ? 0.5 : 1));
  });
  CHECK(error_of(whole_slopes, exact_clamped, ramp) < 1e-3);
  CHECK(error_of(whole_slopes, {}, ramp) < 1e-3);
  CHECK(error_of(halved, {}, ramp) < 1e-3);
}

TEST_CASE("a ramp that is said to wrap is flat") {
  const ImagePtr normals = normals_of({32, 32}, [](int, int) { return Vector2d(0.7, 0.1); });
  CHECK(error_of(normals, exact_wrapped, [](int, int) { return 0; }) < 1e-4);
}

TEST_CASE("a bump keeps its height") {
  const double tall = 10, sigma = 9;
  const auto bump = [&](int x, int y) {
    return tall * std::exp(-((x - 40) * (x - 40) + (y - 33) * (y - 33)) / (2 * sigma * sigma));
  };
  const ImagePtr normals = normals_of({80, 70}, [&](int x, int y) {
    return Vector2d(-bump(x, y) * (x - 40) / (sigma * sigma), -bump(x, y) * (y - 33) / (sigma * sigma));
  });
  CHECK(error_of(normals, exact_clamped, bump) < 1e-4 * tall);
}

TEST_CASE("what no surface can be is left out: a whirl is flat, and a wave beside it stays") {
  const double w = 2 * pi / 64;
  const ImagePtr normals = normals_of({64, 64}, [&](int x, int y) {
    return Vector2d(0.3 * std::sin(w * y) + 2 * w * std::cos(w * x), -0.4 * std::cos(2 * w * x));
  });
  CHECK(error_of(normals, exact_wrapped, [&](int x, int) { return 2 * std::sin(w * x); }) < 1e-4);
}

TEST_CASE("slopes that contradict one another give the least squares that a dense solver finds") {
  const Size size{7, 6};
  const auto random = [](int x, int y, int c) {
    return double(below(uint32_t(random_bits(3, x, y, c)), 2001)) / 1e3 - 1;
  };
  const ImagePtr normals = normals_of(size, [&](int x, int y) { return Vector2d(random(x, y, 0), random(x, y, 1)); });
  // Each rise is 13/24 of the slopes at its ends less 1/24 of those one further, which beyond a border continue.
  const auto slope = [&](int x, int y, int c) {
    const int inside_x = std::clamp(x, 0, size.width - 1), inside_y = std::clamp(y, 0, size.height - 1);
    const int dx = x - inside_x, dy = y - inside_y;
    return random(inside_x, inside_y, c) +
           (dx || dy ? random(inside_x, inside_y, c) - random(inside_x - dx, inside_y - dy, c) : 0);
  };
  const int pixels = int(size.area());
  std::vector<std::array<double, 3>> rises;  // from a pixel, to a pixel, by how much
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const auto along = [&](int i, int c) { return c == 0 ? slope(x + i, y, 0) : slope(x, y + i, 1); };
      const auto rise = [&](int c) { return (13 * (along(0, c) + along(1, c)) - (along(-1, c) + along(2, c))) / 24; };
      const double at = y * size.width + x;
      if (x + 1 < size.width) rises.push_back({at, at + 1, rise(0)});
      if (y + 1 < size.height) rises.push_back({at, at + size.width, rise(1)});
    }
  MatrixXd a = MatrixXd::Zero(int(rises.size()) + 1, pixels);
  VectorXd b = VectorXd::Zero(int(rises.size()) + 1);
  for (int i = 0; i < int(rises.size()); i++) {
    a(i, int(rises[size_t(i)][0])) = -1;
    a(i, int(rises[size_t(i)][1])) = 1;
    b[i] = rises[size_t(i)][2];
  }
  a.row(int(rises.size())).setOnes();  // of mean 0
  const VectorXd best = solve_positive_definite(a.transpose().lazyProduct(a), a.transpose() * b);
  CHECK(error_of(normals, exact_clamped, [&](int x, int y) { return best[y * size.width + x]; }) < 1e-4);
}

TEST_CASE("flattening takes from a wave what the screened equation says") {
  const double w = 2 * pi / 64, flatten = 12;
  const ImagePtr normals = normals_of({64, 16}, [&](int x, int) { return Vector2d(3 * w * std::cos(w * x), 0); });
  IntegrationOptions options = exact_wrapped;
  options.flatten = flatten;
  const double k = 4 * std::sin(w / 2) * std::sin(w / 2), kept = k / (k + 1 / (flatten * flatten));
  CHECK(kept < 0.6);
  CHECK(error_of(normals, options, [&](int x, int) { return 3 * kept * std::sin(w * x); }) < 1e-4);
}

TEST_CASE("a large surface loses next to nothing over its whole length, wrapping or not") {
  const double tall = 100, w = 2 * pi / 1000, v = 2 * pi / 600;
  const auto wave = [&](int x, int y) { return tall * std::sin(w * x) * std::cos(v * y); };
  const ImagePtr normals = normals_of({1000, 600}, [&](int x, int y) {
    return Vector2d(tall * w * std::cos(w * x) * std::cos(v * y), -tall * v * std::sin(w * x) * std::sin(v * y));
  });
  CHECK(error_of(normals, exact_wrapped, wave) < 1e-4 * tall);
  CHECK(error_of(normals, exact_clamped, wave) < 1e-4 * tall);
}

TEST_CASE("normals of 8 bits give the wave to a fraction of a pixel where it wraps") {
  const double w = 2 * pi / 64, tall = 10;
  const auto wave = [&](int x, int y) { return tall * std::sin(w * x) * std::sin(w * y); };
  const ImagePtr exact = normals_of({256, 256}, [&](int x, int y) {
    return Vector2d(tall * w * std::cos(w * x) * std::sin(w * y), tall * w * std::sin(w * x) * std::cos(w * y));
  });
  std::vector<float> pixels = exact->pixels();
  for (float& p : pixels) p = std::round(p * 255) / 255;
  CHECK(error_of(Image::from_floats(exact->info(), std::move(pixels)), exact_wrapped, wave) < 0.005 * tall);
}

TEST_CASE("normals that lie down or say nothing give finite heights") {
  const ImagePtr normals = make_image(
      {9, 9}, 3, [](int x, int y, int c) { return x == 4   ? 0.5f
                                                  : c == 2 ? 0.5f
                                                           : float((x + y) % 2); },
      Semantic::normal);
  for (const float h : heights_from_normals(*normals, {}, {})) CHECK(std::isfinite(h));
}

TEST_CASE("integrating normals can be cancelled") {
  const std::atomic<bool> cancelled = true;
  const ImagePtr normals = normals_of({64, 64}, [](int, int) { return Vector2d(0.1, 0); });
  CHECK_THROWS_AS(heights_from_normals(*normals, {}, Task(&cancelled, nullptr)), Cancelled);
}
