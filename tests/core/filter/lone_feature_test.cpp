#include "core/filter/lone_feature.h"

#include <array>
#include <cstdlib>
#include <functional>
#include <vector>

#include <doctest/doctest.h>

#include "core/base/hash.h"

using namespace terrazzo;

namespace {

LoneFeature loneliest(const std::function<std::array<double, 3>(int, int)>& colour, Size size = {240, 160}) {
  LoneFeatureSearch search(size);
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) search.add(x, y, colour(x, y).data());
  return search.find();
}

double grain(int x, int y) {
  return 0.3 + 0.4 * double(random_bits(1, uint64_t(x), uint64_t(y), 0) % 1000) / 1000;
}

/// Grain with discs of another colour around some places, which wrap around.
std::function<std::array<double, 3>(int, int)> discs(const std::vector<std::array<int, 2>>& places) {
  return [places](int x, int y) -> std::array<double, 3> {
    for (const auto& [u, v] : places) {
      const int dx = std::min(wrap(x - u, 240), wrap(u - x, 240)), dy = std::min(wrap(y - v, 160), wrap(v - y, 160));
      if (dx * dx + dy * dy < 144) return {0.8, 0.1, 0.1};
    }
    const double v = grain(x, y);
    return {v, v, v};
  };
}

}  // namespace

TEST_CASE("what an exemplar shows once is found, and where") {
  const LoneFeature found = loneliest(discs({{150, 60}}));
  CHECK(found.is_seen());
  CHECK(std::abs(found.x - 150) <= 12);
  CHECK(std::abs(found.y - 60) <= 12);
}

TEST_CASE("what it shows twice is no lone feature, even if its border cuts one of them") {
  CHECK_FALSE(loneliest(discs({{150, 60}, {60, 100}})).is_seen());
  CHECK_FALSE(loneliest(discs({{150, 60}, {0, 100}})).is_seen());
}

TEST_CASE("a texture has no lone feature") {
  CHECK_FALSE(loneliest(discs({})).is_seen());
  CHECK_FALSE(loneliest([](int x, int y) -> std::array<double, 3> {
                const double v = x / 20 % 2 == y / 20 % 2 ? 0.2 : 0.8;
                return {v, v, v};
              }).is_seen());
  CHECK(loneliest([](int, int) -> std::array<double, 3> { return {0.5, 0.5, 0.5}; }).strength == 0);
}

TEST_CASE("exemplars too small to tell have none") {
  const auto spot = [](int x, int y) -> std::array<double, 3> {
    const double v = x == 30 && y == 30 ? 1 : 0;
    return {v, v, v};
  };
  CHECK(loneliest(spot, {79, 79}).strength == 0);
  CHECK(loneliest(spot, {400, 60}).strength == 0);
  CHECK(loneliest(spot, {1, 1}).strength == 0);
  CHECK(loneliest(spot, {80, 80}).strength > 0);
}
