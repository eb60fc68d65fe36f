#include "core/filter/normal_convention.h"

#include <cmath>

#include <doctest/doctest.h>

#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

float bumps(double x, double y) {
  return float(0.5 + 0.2 * std::sin(x * 0.31 + 0.2 * y) + 0.2 * std::sin(y * 0.23 - 0.1 * x));
}

ImagePtr height_map(Size size) {
  return make_image(size, 1, [&](int x, int y, int) { return bumps(x * 64.0 / size.width, y * 64.0 / size.height); });
}

ImagePtr normal_map(NormalY convention) {
  return make_image({64, 64}, 3, [&](int x, int y, int c) {
    const float dx = bumps(x + 1, y) - bumps(x - 1, y), dy = bumps(x, y + 1) - bumps(x, y - 1);
    if (c == 2) return 1.0f;
    return 0.5f + (c == 0 ? -dx : convention == NormalY::up ? dy : -dy);
  });
}

}  // namespace

TEST_CASE("normals are compared with the slopes of a height map of any size") {
  for (const Size size : {Size{64, 64}, Size{128, 96}, Size{32, 32}})
    for (const NormalY convention : {NormalY::up, NormalY::down}) {
      const ConventionEvidence e = convention_from_height(*normal_map(convention), *height_map(size));
      CHECK(e.normal_y == convention);
      CHECK(e.along_x > 0.8);
      CHECK_FALSE(e.height_inverted);
    }
}

TEST_CASE("an inverted height map is noticed and does not mislead") {
  const ImagePtr depth = make_image({64, 64}, 1, [](int x, int y, int) { return 1.0f - bumps(x, y); });
  const ConventionEvidence e = convention_from_height(*normal_map(NormalY::up), *depth);
  CHECK(e.normal_y == NormalY::up);
  CHECK(e.height_inverted);
}

TEST_CASE("a height map that has nothing to do with the normals decides nothing") {
  const ImagePtr noise = make_image({64, 64}, 1, [](int x, int y, int) { return float(random_bits(1, x, y) & 255); });
  const ImagePtr flat = make_image({64, 64}, 1, [](int, int, int) { return 0.5f; });
  CHECK_FALSE(convention_from_height(*normal_map(NormalY::up), *noise).normal_y);
  CHECK_FALSE(convention_from_height(*normal_map(NormalY::up), *flat).normal_y);
}

TEST_CASE("grooves that run across leave the decision to green alone") {
  const auto plank = [](int y) { return float(0.5 + 0.3 * std::sin(y * 0.4)); };
  const ImagePtr height = make_image({64, 64}, 1, [&](int, int y, int) { return plank(y); });
  const ImagePtr normal = make_image({64, 64}, 3, [&](int x, int y, int c) {
    return c == 1 ? 0.5f - (plank(y + 1) - plank(y - 1)) : c == 2 ? 1.0f : 0.5f + float(x % 2) * 0.01f;
  });
  CHECK(convention_from_height(*normal, *height).normal_y == NormalY::down);
}

TEST_CASE("without a height map the normals themselves tell, if they vary both ways") {
  CHECK(convention_from_curl(*normal_map(NormalY::up)).normal_y == NormalY::up);
  CHECK(convention_from_curl(*normal_map(NormalY::down)).normal_y == NormalY::down);
  const ImagePtr flat = make_image({64, 64}, 3, [](int, int, int c) { return c == 2 ? 1.0f : 0.5f; });
  CHECK_FALSE(convention_from_curl(*flat).normal_y);
}
