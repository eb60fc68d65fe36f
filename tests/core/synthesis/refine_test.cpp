#include <algorithm>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/synthesis/synthesize.h"
#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// The index of a wall, told that it has a lattice or not.
IndexPtr index_with(const Lattice& lattice, bool wraps, Size size = {72, 64}) {
  const AppearancePtr found = make_appearance(*plain_features(wall(size), wraps), {}, {}, Task());
  return make_index(Appearance::make(found->levels(), found->channels(), wraps, lattice), 3, Task());
}

Lattice bricks() {
  return {2, {16, 0}, {8, 8}, 1};
}

void check_part(const Index& index, const SynthesisOptions& options, const UvMap& coarse, const UvMap& all,
                const Rect& region) {
  CAPTURE(region.x);
  CAPTURE(region.y);
  const UvMapPtr part = refine(index, coarse, options, region, Task());
  REQUIRE(part->size() == Size{region.width, region.height});
  int different = 0;
  for (int y = 0; y < region.height; y++)
    for (int x = 0; x < region.width; x++)
      different +=
          part->at(x, y) != all.at(wrap(region.x + x, all.size().width), wrap(region.y + y, all.size().height));
  INFO("If a step of the finest level reads farther than reach_of() allows for, parts differ from the whole.");
  CHECK(different == 0);
}

}  // namespace

TEST_CASE("parts made apart from one another are parts of the whole, bit for bit") {
  for (const bool regular : {false, true})
    for (const bool wraps : {false, true}) {
      CAPTURE(regular);
      CAPTURE(wraps);
      const IndexPtr index = index_with(regular ? bricks() : Lattice{}, wraps);
      // Longer than an apron on either side; the other axis is short, to be quick.
      const Size size = wraps ? Size{38, 471} : Size{531, 45};
      const SynthesisOptions options{.size = size, .seed = 3, .jitter = {1, 1, 1, 1}};
      const UvMapPtr all = synthesize(*index, options, Task());
      const UvMapPtr coarse = coarse_uv(*index, options, Task());
      const int middle = std::max(size.width, size.height) / 2;
      for (const Rect& r : {Rect{0, 0, 20, 30}, whole(size), Rect{size.width - 1, size.height - 1, 1, 1},
                            wraps ? Rect{3, middle, 31, 17} : Rect{middle, 9, 17, 31}})
        check_part(*index, options, *coarse, *all, r);
    }
}

TEST_CASE("parts are right where every pixel is uncertain and changes spread as far as they can") {
  const ImagePtr speckles =
      make_image({64, 64}, 1, [](int x, int y, int) { return float(unit_double(random_bits(9, x, y))); });
  const IndexPtr index = make_index(make_appearance(*plain_features(speckles), {}, {}, Task()), 3, Task());
  const SynthesisOptions options{.size = {420, 40}, .coherence = 1, .jitter = {9, 9, 9, 9}};
  const UvMapPtr all = synthesize(*index, options, Task());
  const UvMapPtr coarse = coarse_uv(*index, options, Task());
  for (int x = 5; x < 415; x += 67) check_part(*index, options, *coarse, *all, {x, x % 37, 3, 3});
}

TEST_CASE("parts of a surface that tiles go on around its border") {
  for (const bool regular : {false, true})
    for (const Size size : {Size{512, 48}, Size{514, 47}, Size{51, 460}}) {
      CAPTURE(regular);
      CAPTURE(size.width);
      const IndexPtr index = index_with(regular ? bricks() : Lattice{}, false);
      const SynthesisOptions options{.size = size, .seed = 5, .tile_x = true, .tile_y = true};
      const UvMapPtr all = synthesize(*index, options, Task());
      const UvMapPtr coarse = coarse_uv(*index, options, Task());
      for (const Rect& r : {Rect{0, 0, 24, 20}, Rect{size.width - 10, size.height - 7, 21, 18}, Rect{20, 21, 33, 27}})
        check_part(*index, options, *coarse, *all, r);
    }
}

TEST_CASE("the coarse levels are a quarter of the whole, with and without a lattice") {
  const SynthesisOptions options{.size = {202, 99}};
  for (const Lattice& lattice : {Lattice{}, bricks()}) {
    const UvMapPtr coarse = coarse_uv(*index_with(lattice, false), options, Task());
    CHECK(coarse->size() == Size{101, 50});
    CHECK(coarse->exemplar() == Size{72, 64});
  }
}

TEST_CASE("an exemplar of one level has nothing to refine, and parts of it are right") {
  const IndexPtr index = index_with({}, false, {20, 18});
  REQUIRE(index->levels().size() == 1);
  const SynthesisOptions options{.size = {70, 50}};
  const UvMapPtr all = synthesize(*index, options, Task());
  const UvMapPtr coarse = coarse_uv(*index, options, Task());
  check_part(*index, options, *coarse, *all, {13, 9, 40, 30});
}

TEST_CASE("evenness, control and kept pixels are the same in parts, and seams that move where nothing steers") {
  const IndexPtr index = index_with({}, false);
  SynthesisOptions options{.size = {460, 50}, .evenness = 2};
  options.kept = {std::vector<ExemplarPixel>(size_t(options.size.area())),
                  std::vector<Keep>(size_t(options.size.area()))};
  for (int y = 10; y < 30; y++)
    for (int x = 210; x < 250; x++) {
      options.kept.keep[size_t(y) * 460 + x] = Keep::always;
      options.kept.pixels[size_t(y) * 460 + x] = {uint16_t(x - 200), uint16_t(y)};
    }
  const auto shade = [](Size size) { return make_image(size, 1, [](int x, int, int) { return float(x % 50) / 50; }); };
  options.controls = {{.exemplar = shade({72, 64}), .target = shade(options.size)}};
  const UvMapPtr all = synthesize(*index, options, Task());
  const UvMapPtr coarse = coarse_uv(*index, options, Task());
  check_part(*index, options, *coarse, *all, {200, 5, 20, 40});
  CHECK(all->at(220, 20) == ExemplarPixel{20, 20});
  options.controls.clear();
  check_part(*index, options, *coarse_uv(*index, options, Task()), *synthesize(*index, options, Task()),
             {200, 5, 20, 40});
}

TEST_CASE("coarse levels of another surface, exemplar or wrapping are refused") {
  const IndexPtr index = index_with({}, false);
  const SynthesisOptions options{.size = {200, 160}};
  const UvMapPtr coarse = coarse_uv(*index, options, Task());
  const Rect part{0, 0, 10, 10};
  CHECK_THROWS_WITH_AS(refine(*index, *coarse, {.size = {400, 160}}, part, Task()), doctest::Contains("same surface"),
                       Error);
  CHECK_THROWS_WITH_AS(refine(*index, *coarse, {.size = {200, 160}, .tile_x = true}, part, Task()),
                       doctest::Contains("same \"tileable\""), Error);
  CHECK_THROWS_WITH_AS(refine(*index_with({}, false, {80, 64}), *coarse, options, part, Task()),
                       doctest::Contains("same index"), Error);
  CHECK_THROWS_WITH_AS(refine(*index, *coarse, options, {195, 0, 10, 10}, Task()),
                       doctest::Contains("rectangle inside the surface"), Error);
}
