#include "core/metrics/hybrids.h"

#include <functional>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "tests/drawn_stones.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

const Task task;
constexpr Size exemplar{240, 240};

UvMapPtr layout(Size size, const std::function<ExemplarPixel(int, int)>& place, UvWraps wraps = {.exemplar = true}) {
  std::vector<ExemplarPixel> pixels;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) pixels.push_back(place(x, y));
  return UvMap::make(size, exemplar, std::move(pixels), wraps);
}

ExemplarPixel at(int x, int y) {
  return {uint16_t(wrap(x, 240)), uint16_t(wrap(y, 240))};
}

}  // namespace

TEST_CASE("what is copied as a whole has no hybrids") {
  const DrawnStones stones(exemplar);
  const HybridElements h =
      hybrid_elements(*layout(exemplar, at, {.x = true, .y = true, .exemplar = true}), stones.elements(), task);
  CHECK(h.elements == 36);
  CHECK(h.by_area == 0);
  CHECK(h.by_number == 0);
}

TEST_CASE("elements that the result's border cuts do not count") {
  const DrawnStones stones(exemplar);
  const HybridElements h = hybrid_elements(*layout(exemplar, at), stones.elements(), task);
  CHECK(h.elements < 36);
  CHECK(h.elements > 8);
  CHECK(h.by_area == 0);
}

TEST_CASE("strips from elsewhere make hybrids of the stones that they cross") {
  const DrawnStones stones(exemplar);
  const auto shifted = [&](int every) {
    return hybrid_elements(
        *layout({400, 400}, [&](int x, int y) { return at(x + x / every * 53, y + x / every * 31); }),
        stones.elements(), task);
  };
  const HybridElements many = shifted(15), few = shifted(60);
  CHECK(many.by_area > 0.8);
  CHECK(few.by_area > 0.15);
  CHECK(few.by_area < 0.7);
  CHECK(few.by_number < many.by_number);
}

TEST_CASE("a stone that is bent by a pixel here and there is whole") {
  const DrawnStones stones(exemplar);
  const HybridElements h = hybrid_elements(*layout({300, 300}, [](int x, int y) { return at(x - x / 12, y - y / 15); }),
                                           stones.elements(), task);
  CHECK(h.by_area < 0.05);
}

TEST_CASE("labels are told apart by their values, and must fit the uv map") {
  const ImagePtr labels = make_image({8, 8}, 1, [](int x, int y, int) { return float(x / 4 + 2 * (y / 4)) / 3; });
  const Elements elements = labelled_elements(labels, {16, 16}, task);
  CHECK(elements.count == 4);
  CHECK(elements.at[0] == 0);
  CHECK(elements.at[15] == 1);
  CHECK(elements.at[255] == 3);
  CHECK_THROWS_AS(hybrid_elements(*layout(exemplar, at), elements, task), Error);
}
