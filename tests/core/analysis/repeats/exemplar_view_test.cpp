#include "core/analysis/repeats/exemplar_view.h"

#include <doctest/doctest.h>

using namespace terrazzo;

namespace {

Planes ramp(Size size, bool wraps) {
  Planes planes{size, 1, wraps, {}};
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) planes.values.push_back(float(x + 1000 * y));
  return planes;
}

}  // namespace

TEST_CASE("a view of all of an exemplar is as it is, and large ones are halved") {
  const ExemplarView small = view_of(ramp({60, 40}, true), {}, {0, 0, 60, 40});
  CHECK(small.planes.values == ramp({60, 40}, true).values);
  CHECK(small.planes.wraps);
  CHECK(small.scale == 1);
  CHECK(small.counts.values.empty());
  const ExemplarView large = view_of(ramp({600, 40}, false), {}, {0, 0, 600, 40});
  CHECK(large.planes.size == Size{150, 10});
  CHECK(large.scale == 4);
  CHECK(large.empty());
}

TEST_CASE("a view of a part shows that, and no more of it than may be sampled") {
  const Planes planes = ramp({60, 40}, true);
  const ExemplarView part = view_of(planes, {}, {20, 10, 30, 25});
  CHECK(*part.planes.at(0, 0) == 20 + 10000);
  CHECK_FALSE(part.planes.wraps);
  std::vector<uint8_t> allowed(60 * 40, 0);
  for (int y = 12; y < 32; y++)
    for (int x = 18; x < 40; x++) allowed[size_t(y) * 60 + size_t(x)] = 1;
  const ExemplarView seen = view_of(planes, allowed, {20, 10, 30, 25});
  CHECK(seen.seen == Rect{20, 12, 20, 20});
  CHECK(seen.counts.values.empty());
  allowed[12 * 60 + 21] = 0;
  const ExemplarView holed = view_of(planes, allowed, {20, 10, 30, 25});
  CHECK(*holed.counts.at(1, 0) == 0);
  CHECK(*holed.counts.at(2, 0) == 1);
  CHECK(view_of(planes, std::vector<uint8_t>(60 * 40, 0), {0, 0, 60, 40}).empty());
}

TEST_CASE("views of several parts have the scale that the largest needs") {
  const std::vector<ExemplarView> views =
      views_at_one_scale(ramp({700, 100}, false), {}, {{0, 0, 600, 90}, {610, 0, 80, 80}});
  REQUIRE(views.size() == 2);
  CHECK(views[0].scale == 4);
  CHECK(views[1].scale == 4);
  CHECK(views[1].planes.size == Size{20, 20});
}
