#include "core/resolve/resolve.h"

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

ImagePtr map_of(Size size, int channels, int which, Semantic semantic) {
  return make_image(
      size, channels, [which](int x, int y, int c) { return float(random_bits(which, x, y, c) % 256) / 255; },
      semantic);
}

MaterialPtr exemplar() {
  return Material::make("stone", {{"base_color", map_of({20, 14}, 3, 1, Semantic::base_color)},
                                  {"normal", map_of({20, 14}, 3, 2, Semantic::normal)},
                                  {"height", map_of({10, 7}, 1, 3, Semantic::height)}});
}

UvMapPtr uv_map(Size size) {
  std::vector<ExemplarPixel> pixels;
  for (int i = 0; i < size.area(); i++)
    pixels.push_back({uint16_t(random_bits(4, i) % 20), uint16_t(random_bits(5, i) % 14)});
  return UvMap::make(size, {20, 14}, std::move(pixels));
}

}  // namespace

TEST_CASE("every output pixel of every map is the exemplar pixel that the uv map names") {
  const UvMapPtr uv = uv_map({31, 17});
  const MaterialPtr out =
      run_node("resolve_uv", {}, {{"uv", {uv}}, {"material", {exemplar()}}}).get<Material>("material");
  REQUIRE(out->maps().size() == 3);
  for (const Map& map : out->maps()) {
    const ImagePtr from = exemplar()->find(map.name);
    CHECK(map.image->info().semantic == from->info().semantic);
    const std::vector<float> got = map.image->pixels();
    const int n = from->channels(), shrink = 20 / from->width();
    for (int i = 0; i < 31 * 17; i++) {
      const ExemplarPixel p = uv->at(i % 31, i / 31);
      for (int c = 0; c < n; c++)
        REQUIRE(got[i * n + c] == from->in_memory()[((p.y / shrink) * from->width() + p.x / shrink) * n + c]);
    }
  }
}

TEST_CASE("a window of the resolved map is that window of the whole, however it is resolved") {
  for (const double blend : {0.0, 2.5}) {
    const MaterialPtr out = resolved(*exemplar(), uv_map({31, 17}), {.blend = blend});
    for (const Map& map : out->maps()) {
      const int n = map.image->channels();
      const std::vector<float> all = map.image->pixels(), window = map.image->read({5, 3, 9, 4});
      for (int y = 0; y < 4; y++)
        for (int i = 0; i < 9 * n; i++) REQUIRE(window[y * 9 * n + i] == all[((y + 3) * 31 + 5) * n + i]);
    }
  }
}

TEST_CASE("a map of another shape than the rest is refused, not stretched") {
  const ImagePtr square = make_image(
      {10, 10}, 1, [](int x, int, int) { return float(x); }, Semantic::roughness);
  std::vector<Map> maps = exemplar()->maps();
  maps.push_back({"roughness", square});
  CHECK_THROWS_WITH_AS(resolved(*Material::make("m", std::move(maps)), uv_map({8, 8})),
                       doctest::Contains("10x10 (roughness)"), Error);
}

TEST_CASE("a uv map made for another exemplar is refused with both sizes") {
  const UvMapPtr other = UvMap::make({2, 2}, {64, 64}, std::vector<ExemplarPixel>(4));
  CHECK_THROWS_WITH_AS(resolved(*exemplar(), other),
                       "the uv map was made for an exemplar of 64x64 pixels, this one has 20x14", Error);
  CHECK_THROWS_AS(resolved(*exemplar(), other, {.scale = 0}), Error);
  const UvMapPtr half = UvMap::make({2, 2}, {10, 7}, std::vector<ExemplarPixel>(4));
  CHECK_THROWS_WITH_AS(resolved(*exemplar(), half), doctest::Contains("set \"scale\" to 2"), Error);
  CHECK_THROWS_WITH_AS(resolved(*exemplar(), half, {.scale = 3}), doctest::Contains("needs one of 30x21"), Error);
}
