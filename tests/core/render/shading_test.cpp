#include "core/render/shading.h"

#include <cmath>

#include <doctest/doctest.h>

using namespace terrazzo::render;

TEST_CASE("a surface reflects no more light than it gets") {
  for (const double roughness : {0.15, 0.4, 1.0})
    for (const double metallic : {0.0, 1.0})
      for (const double tilt : {0.0, 0.9, 1.4}) {
        ShadedPoint p{.albedo = {1, 1, 1}, .roughness = roughness, .metallic = metallic};
        const Vec light{std::sin(tilt), 0, std::cos(tilt)};
        // The mean over cosine-weighted view directions, per light that falls in.
        double sum = 0;
        constexpr int rings = 200, sides = 128;
        for (int i = 0; i < rings; i++)
          for (int j = 0; j < sides; j++) {
            const double s2 = (i + 0.5) / rings, s = std::sqrt(s2), a = 6.283185307 * (j + 0.5) / sides;
            sum += reflected(p, {s * std::cos(a), s * std::sin(a), std::sqrt(1 - s2)}, light).x / (rings * sides);
          }
        const double share = sum / light.z;
        CAPTURE(roughness);
        CAPTURE(tilt);
        CHECK(share < 1.03);
        CHECK(share > 0.4);
      }
}

TEST_CASE("light and view may change places") {
  const ShadedPoint p{.albedo = {0.9, 0.6, 0.2}, .roughness = 0.3, .metallic = 1};
  const Vec a = unit({0.4, 0.1, 0.8}), b = unit({-0.5, 0.6, 0.5});
  CHECK(reflected(p, a, b).x / b.z == doctest::Approx(reflected(p, b, a).x / a.z));
}

TEST_CASE("tone mapping keeps what fits, and grows without reaching white") {
  CHECK(tone_mapped({0.5, 0.75, 0}).x == 0.5);
  CHECK(tone_mapped({0.5, 0.75, 0}).y == 0.75);
  double before = 0.75;
  for (double x = 0.8; x < 100; x *= 1.5) {
    const double y = tone_mapped({x, 0, 0}).x;
    CHECK(y > before);
    CHECK(y < 1);
    before = y;
  }
}

TEST_CASE("the sRGB transfer function and its inverse undo each other") {
  for (double x = 0; x <= 1; x += 0.01) CHECK(srgb_decoded(srgb_encoded(x)) == doctest::Approx(x).epsilon(1e-4));
  CHECK(srgb_encoded(0.5) == doctest::Approx(0.735357).epsilon(1e-5));
}
