#include "core/picture/render/shading.h"

#include <cmath>
#include <initializer_list>

#include <doctest/doctest.h>

using namespace terrazzo;
using namespace terrazzo::render;

namespace {

/// The share of a light at `tilt` from the normal that a surface reflects in all directions together.
double reflected_share(const ShadedPoint& p, double tilt) {
  const Vector3d light{std::sin(tilt), 0, std::cos(tilt)};
  constexpr int rings = 200, sides = 128;
  double sum = 0;
  for (int i = 0; i < rings; i++)
    for (int j = 0; j < sides; j++) {
      const double s2 = (i + 0.5) / rings, s = std::sqrt(s2), a = 6.283185307 * (j + 0.5) / sides;
      sum += reflected(p, {s * std::cos(a), s * std::sin(a), std::sqrt(1 - s2)}, light).x() / (rings * sides);
    }
  return sum / light.z();
}

}  // namespace

TEST_CASE("a surface reflects no more light than it gets") {
  for (const double roughness : {0.3, 0.5, 1.0})
    for (const double metallic : {0.0, 1.0})
      for (const double tilt : {0.0, 0.5, 0.9}) {
        CAPTURE(roughness);
        CAPTURE(metallic);
        CAPTURE(tilt);
        const double share = reflected_share({.albedo = {1, 1, 1}, .roughness = roughness, .metallic = metallic}, tilt);
        CHECK(share < 1.01);
        CHECK(share > 0.3);
      }
}

TEST_CASE("the roughest metal reflects 1 - ln 2 of a light from straight above, as the integral says") {
  const ShadedPoint p{.albedo = {1, 1, 1}, .roughness = 1, .metallic = 1};
  CHECK(reflected_share(p, 0) == doctest::Approx(1 - std::log(2.0)).epsilon(1e-3));
}

TEST_CASE("light and view may change places") {
  const ShadedPoint p{.albedo = {0.9, 0.6, 0.2}, .roughness = 0.3, .metallic = 1};
  const Vector3d a = Vector3d{0.4, 0.1, 0.8}.normalized(), b = Vector3d{-0.5, 0.6, 0.5}.normalized();
  CHECK(reflected(p, a, b).x() / b.z() == doctest::Approx(reflected(p, b, a).x() / a.z()));
}

TEST_CASE("tone mapping keeps what fits, and grows without reaching white") {
  CHECK(tone_mapped({0.5, 0.75, 0}).x() == 0.5);
  CHECK(tone_mapped({0.5, 0.75, 0}).y() == 0.75);
  double before = 0.75;
  for (double x = 0.8; x < 100; x *= 1.5) {
    const double y = tone_mapped({x, 0, 0}).x();
    CHECK(y > before);
    CHECK(y < 1);
    before = y;
  }
}
