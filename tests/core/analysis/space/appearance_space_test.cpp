#include "core/analysis/space/appearance_space.h"

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("levels halve down to a coarsest of at least 16 pixels a side") {
  const AppearancePtr a = make_appearance(*plain_features(wall({70, 130})), {}, {}, Task());
  REQUIRE(a->levels().size() == 3);
  CHECK(a->levels()[0].size == Size{70, 130});
  CHECK(a->levels()[1].size == Size{35, 65});
  CHECK(a->levels()[2].size == Size{18, 33});
}

TEST_CASE("the appearance does not depend on the number of threads") {
  const FeaturesPtr features = plain_features(wall({64, 48}));
  Digest one, four;
  tbb::task_arena(1).execute([&] { one = make_appearance(*features, {}, {}, Task())->digest(); });
  tbb::task_arena(4).execute([&] { four = make_appearance(*features, {}, {}, Task())->digest(); });
  CHECK(one == four);
}

TEST_CASE("equal neighbourhoods have equal vectors, unlike ones do not") {
  const ImagePtr stripes = make_image({32, 32}, 1, [](int x, int, int) { return x % 8 < 4 ? 0.f : 1.f; });
  const AppearanceLevel level = make_appearance(*plain_features(stripes), {}, {}, Task())->levels()[0];
  const auto at = [&](int x, int y) { return level.vectors[y * 32 + x]; };
  CHECK(at(10, 10) == at(18, 21));
  CHECK(at(10, 10) != at(12, 10));
}

TEST_CASE("dimensions are limited by number and by retained variance") {
  const FeaturesPtr features = plain_features(wall({48, 48}));
  CHECK(make_appearance(*features, {}, {.dimensions = 3}, Task())->levels()[0].dimensions == 3);
  const AppearanceLevel few = make_appearance(*features, {}, {.retained_variance = 0.5}, Task())->levels()[0];
  CHECK(few.dimensions < 8);
  CHECK(few.retained >= 0.5);
  for (const AppearanceVector& v : few.vectors) REQUIRE(v[7] == 0);
}

TEST_CASE("guidance shapes coarse levels and leaves the finest alone") {
  const ImagePtr image = wall({64, 64});
  const ImagePtr guide = make_image(
      {64, 64}, 1, [](int x, int, int) { return float(x); }, Semantic::guidance);
  const AppearancePtr without = make_appearance(*plain_features(image), {}, {}, Task());
  const AppearancePtr with = make_appearance(*plain_features(image), {guide}, {}, Task());
  CHECK(without->levels()[0].vectors == with->levels()[0].vectors);
  CHECK(without->levels()[2].vectors != with->levels()[2].vectors);
}

TEST_CASE("an exemplar of one colour is no trouble") {
  const ImagePtr flat = make_image({16, 20}, 3, [](int, int, int) { return 0.5f; });
  const AppearancePtr a = make_appearance(*plain_features(flat), {}, {}, Task());
  for (const AppearanceVector& v : a->levels()[0].vectors) REQUIRE(v == a->levels()[0].vectors[0]);
}

TEST_CASE("too small an exemplar and guidance of another size are refused with the sizes") {
  CHECK_THROWS_WITH_AS(make_appearance(*plain_features(wall({15, 40})), {}, {}, Task()),
                       "the exemplar has 15x40 pixels; it needs at least 16 and at most 65536 a side", Error);
  CHECK_THROWS_WITH_AS(make_appearance(*plain_features(wall({32, 32})), {wall({16, 32})}, {}, Task()),
                       "expected an image of the features' size, 32x32, found 16x32; put \"resize\" before it", Error);
}

TEST_CASE("guidance counts the same in pixels as in parts of their greatest") {
  const FeaturesPtr features = plain_features(wall({64, 64}));
  const auto guided = [&](float strength) {
    const ImagePtr guide = make_image(
        {64, 64}, 1, [&](int x, int, int) { return strength * float(x); }, Semantic::guidance);
    return make_appearance(*features, {guide}, {}, Task())->levels()[2].vectors;
  };
  CHECK(guided(1.0f) == guided(1.0f / 64));
}
