#include "core/metrics/layout.h"

#include <functional>

#include <doctest/doctest.h>

#include "tests/core/metrics/textures.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr Size exemplar_size{32, 32};

UvMapPtr layout(Size size, const std::function<ExemplarPixel(int, int)>& place) {
  std::vector<ExemplarPixel> pixels;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) pixels.push_back(place(x, y));
  return UvMap::make(size, exemplar_size, std::move(pixels));
}

ExemplarPixel at(uint64_t x, uint64_t y) {
  return {uint16_t(x % 32), uint16_t(y % 32)};
}

UvMapPtr blocks(int block) {
  return layout({64, 64}, [block](int x, int y) {
    const uint64_t from = uint64_t(32 - block + 1), bx = uint64_t(x / block), by = uint64_t(y / block);
    return at(random_bits(1, bx, by, 0) % from + uint64_t(x % block),
              random_bits(1, bx, by, 1) % from + uint64_t(y % block));
  });
}

const Planes& exemplar() {
  static const Planes planes = bricks(exemplar_size, 1);
  return planes;
}

}  // namespace

TEST_CASE("the exemplar laid out once has no seams, is one copy, and is evenly used") {
  const LayoutFigures f = layout_figures(*layout({32, 32}, at), exemplar(), false);
  CHECK(f.seam_share == 0);
  CHECK(f.seam_difference == 0);
  CHECK(f.seam_energy == 0);
  CHECK(f.usage_entropy == doctest::Approx(1));
  CHECK(f.largest_copy == 1);
  CHECK(f.verbatim == 1);
}

TEST_CASE("tiling has seams at the exemplar's edge unless the exemplar wraps") {
  const UvMapPtr tiling = layout({64, 64}, at);
  const LayoutFigures cut = layout_figures(*tiling, exemplar(), false),
                      whole = layout_figures(*tiling, exemplar(), true);
  CHECK(cut.seam_share == doctest::Approx(2.0 * 64 / (2 * 64 * 63)));
  CHECK(cut.largest_copy == 1);
  CHECK(whole.seam_share == 0);
  CHECK(whole.largest_copy == 4);
}

TEST_CASE("smaller blocks mean more seams, smaller copies and more seam energy, to single pixels") {
  LayoutFigures before = layout_figures(*layout({64, 64}, at), exemplar(), false);
  for (const int block : {16, 4, 1}) {
    const LayoutFigures f = layout_figures(*blocks(block), exemplar(), false);
    CHECK(f.seam_share > before.seam_share);
    CHECK(f.seam_energy > before.seam_energy);
    CHECK(f.largest_copy < before.largest_copy);
    CHECK(f.verbatim < before.verbatim);
    CHECK(f.seam_energy == doctest::Approx(f.seam_share * f.seam_difference));
    before = f;
  }
  CHECK(before.seam_share > 0.95);
}

TEST_CASE("seams do not show in a flat exemplar") {
  const LayoutFigures f = layout_figures(*blocks(4), Planes::zeros(exemplar_size, 2), false);
  CHECK(f.seam_share > 0.2);
  CHECK(f.seam_difference == 0);
}

TEST_CASE("using one corner of the exemplar is uneven use") {
  const UvMapPtr corner = layout({64, 64}, [](int x, int y) { return at(uint64_t(x % 8), uint64_t(y % 8)); });
  // 8x8 pixels are 16 of the 256 cells: half of the maximum, log 16 / log 256.
  CHECK(layout_figures(*corner, exemplar(), false).usage_entropy == doctest::Approx(0.5));
}

TEST_CASE("an exemplar of another size than the uv map's is resampled") {
  const LayoutFigures f = layout_figures(*blocks(8), resampled(exemplar(), {64, 64}), false);
  CHECK(f.seam_difference ==
        doctest::Approx(layout_figures(*blocks(8), exemplar(), false).seam_difference).epsilon(0.2));
}
