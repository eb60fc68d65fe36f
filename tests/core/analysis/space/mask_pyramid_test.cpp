#include "core/analysis/space/mask_pyramid.h"

#include <algorithm>

#include <doctest/doctest.h>

#include "core/analysis/space/planes.h"
#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

int count(const std::vector<uint8_t>& v) {
  return int(std::count(v.begin(), v.end(), 1));
}

std::vector<uint8_t> rectangle(Size size, const Rect& r) {
  std::vector<uint8_t> out(size_t(size.area()));
  for (int y = r.y; y < r.bottom(); y++)
    for (int x = r.x; x < r.right(); x++) out[y * size.width + x] = 1;
  return out;
}

MaterialPtr wall_of(Size size) {
  return Material::make("wall", {{"base_color", wall(size)}});
}

ImagePtr left_half(Size size) {
  return make_image(size, 1, [&](int x, int, int) { return x < size.width / 2 ? 1.0f : 0.0f; });
}

}  // namespace

TEST_CASE("without a mask every pixel is usable") {
  CHECK(allowed_pixels(*weighted_features(*wall_of({32, 32}), {}, false)).empty());
  CHECK(usable_pixels({}, {32, 32}, 1, false).empty());
}

TEST_CASE("a pixel is usable if its window sees allowed pixels only, around the borders of an exemplar that tiles") {
  const Size size{40, 30};
  CHECK(usable_pixels(rectangle(size, {10, 5, 20, 15}), size, 0, false) == rectangle(size, {12, 7, 16, 11}));
  CHECK(usable_pixels(rectangle(size, {0, 0, 40, 20}), size, 0, false) == rectangle(size, {2, 2, 36, 16}));
  CHECK(usable_pixels(rectangle(size, {0, 0, 40, 20}), size, 0, true) == rectangle(size, {0, 2, 40, 16}));
  CHECK(usable_pixels(rectangle(size, {8, 8, 20, 16}), size, 1, false) == rectangle({20, 15}, {6, 6, 6, 4}));
}

TEST_CASE("where windows leave too little, all allowed pixels are usable, and at coarse levels any above them") {
  const Size size{40, 30};
  const std::vector<uint8_t> thin = rectangle(size, {10, 5, 20, 2});
  CHECK(usable_pixels(thin, size, 0, false) == thin);
  CHECK(usable_pixels(thin, size, 1, false) == rectangle({20, 15}, {5, 2, 10, 2}));
  const std::vector<uint8_t> dot = rectangle(size, {39, 29, 1, 1});
  for (int level = 0; level < 4; level++) CHECK(count(usable_pixels(dot, size, level, false)) == 1);
}

TEST_CASE("a mask may have any size of the exemplar's shape, and must allow something") {
  const FeaturesPtr features = weighted_features(*wall_of({32, 24}), {}, false, left_half({64, 48}));
  CHECK(allowed_pixels(*features) == rectangle({32, 24}, {0, 0, 16, 24}));
  CHECK(allowed_pixels(*features->with(Lattice{})) == allowed_pixels(*features));
  CHECK(features->digest() != weighted_features(*wall_of({32, 24}), {}, false)->digest());
  CHECK_THROWS_WITH_AS(weighted_features(*wall_of({32, 24}), {}, false, left_half({64, 64})),
                       doctest::Contains("aspect ratio of the exemplar, 32x24"), Error);
  const ImagePtr black = make_image({32, 24}, 1, [](int, int, int) { return 0.5f; });
  CHECK_THROWS_WITH_AS(allowed_pixels(*weighted_features(*wall_of({32, 24}), {}, false, black)),
                       doctest::Contains("allows no pixel of the exemplar"), Error);
}

TEST_CASE("what a mask forbids leaves no trace in the analysis") {
  const ImagePtr clean = wall({32, 32});
  const ImagePtr dirty = make_image(
      {32, 32}, 3, [&](int x, int y, int c) { return x < 16 ? clean->in_memory()[(y * 32 + x) * 3 + c] : 77.0f; },
      Semantic::base_color, "srgb_texture");
  const auto planes = [](const ImagePtr& image) {
    const FeaturesPtr plain = plain_features(image);
    return *weighted_planes(*Features::make(plain->size(), plain->images(), false, {}, left_half({32, 32})), Task());
  };
  CHECK(planes(clean).values == planes(dirty).values);
}
