#include "core/image/srgb.h"

#include <doctest/doctest.h>

using namespace terrazzo;

TEST_CASE("the sRGB transfer function is that of the standard, on both sides of zero") {
  for (double x = 0.01; x < 40; x *= 1.3) {
    const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
    CHECK(encode_srgb(x) == doctest::Approx(encoded).epsilon(1e-9));
    CHECK(encode_srgb(-x) == -encode_srgb(x));
    const double decoded = x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
    CHECK(decode_srgb(x) == doctest::Approx(decoded).epsilon(1e-9));
    CHECK(decode_srgb(-x) == -decode_srgb(x));
  }
}

TEST_CASE("the sRGB transfer function and its inverse undo each other") {
  for (double x = 0; x <= 1; x += 0.01) CHECK(decode_srgb(encode_srgb(x)) == doctest::Approx(x).epsilon(1e-4));
}

TEST_CASE("the values of 8-bit files are decoded like any other") {
  for (int byte = 0; byte < 256; byte++) {
    const float v = float(byte) / 255;
    CHECK(decode_srgb(v) == decode_srgb(double(v)));
  }
}
