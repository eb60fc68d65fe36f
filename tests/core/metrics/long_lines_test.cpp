#include "core/metrics/long_lines.h"

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "core/base/hash.h"

using namespace terrazzo;

namespace {

constexpr int side = 128;

/// Joints all along the exemplar, two of them level and one upright, on grain; or grain alone.
AppearancePtr exemplar(bool has_joints, std::vector<uint8_t> usable = {}) {
  AppearanceLevel level;
  level.usable = std::move(usable);
  level.size = {side, side};
  for (int y = 0; y < side; y++)
    for (int x = 0; x < side; x++) {
      AppearanceVector v{};
      v[0] = int16_t(random_bits(3, x, y) % 200);
      if (has_joints && (y % 64 < 4 || (x + 20) % 128 < 4)) v[0] = -800;
      level.vectors.push_back(v);
    }
  return Appearance::make({level}, 1, level.usable.empty());
}

UvMapPtr laid(Size size, const std::function<int(int, int)>& moved) {
  std::vector<ExemplarPixel> pixels;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++)
      pixels.push_back({uint16_t((x + moved(x, y)) % side), uint16_t((y + moved(y, x)) % side)});
  return UvMap::make(size, {side, side}, std::move(pixels), {false, false, true});
}

int as_it_is(int, int) {
  return 5;
}
int in_blocks(int x, int y) {
  return int(random_bits(7, x / 20, y / 20) % side);
}

}  // namespace

TEST_CASE("a result that repeats its exemplar keeps all long lines") {
  const LongLines kept = long_lines(*laid({300, 260}, as_it_is), *exemplar(true), {});
  CHECK(kept.share > 0.2);
  CHECK(kept.kept == doctest::Approx(1).epsilon(0.2));
  CHECK_FALSE(kept.are_broken());
}

TEST_CASE("joints that end at the border of every block are broken, and grain has none that could be") {
  CHECK(long_lines(*laid({300, 260}, in_blocks), *exemplar(true), {}).are_broken());
  CHECK_FALSE(long_lines(*laid({300, 260}, in_blocks), *exemplar(false), {}).are_broken());
}

TEST_CASE("of a result smaller than its exemplar nothing is told") {
  CHECK(long_lines(*laid({100, 300}, in_blocks), *exemplar(true), {}).share == 0);
}

TEST_CASE("lines are told of where a mask leaves a rectangle of the exemplar, but of no other shape") {
  std::vector<uint8_t> usable(size_t(side) * side, 1);
  for (int y = 0; y < side; y++)
    for (int x = 0; x < 16; x++) usable[size_t(y) * side + size_t(x)] = 0;
  CHECK(long_lines(*laid({300, 260}, in_blocks), *exemplar(true, usable), {}).are_broken());
  usable[64 * side + 64] = 0;
  CHECK(long_lines(*laid({300, 260}, in_blocks), *exemplar(true, usable), {}).share == 0);
}
