#include <algorithm>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "tests/drawn_stones.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr Size side{240, 240};

IndexPtr stones_index(bool with_elements) {
  const DrawnStones stones(side);
  FeaturesPtr features = plain_features(stones.image(), true);
  if (with_elements) features = features->with(std::make_shared<const Elements>(stones.elements()));
  return make_index(make_appearance(*features, {}, {}, Task()), 3, Task());
}

/// Through the middle of the third row of six.
constexpr int fault = 100;

/// The exemplar itself, moved below the fault.
UvMapPtr moved_below(int by) {
  std::vector<ExemplarPixel> pixels;
  for (int y = 0; y < side.height; y++)
    for (int x = 0; x < side.width; x++)
      pixels.push_back({uint16_t((x + (y < fault ? 0 : by)) % side.width), uint16_t(y)});
  return UvMap::make(side, side, std::move(pixels), {true, false, true});
}

double share(const NodeRun& run) {
  const ImagePtr mask = run.get<Image>("mask");
  CHECK(mask->info().semantic == Semantic::mask);
  CHECK(mask->info().size == side);
  double sum = 0;
  for (const float v : mask->pixels()) sum += v;
  return sum / double(side.area());
}

}  // namespace

TEST_CASE("torn_elements marks the stones along a fault, and nothing in the exemplar itself") {
  const IndexPtr index = stones_index(true);
  const NodeRun whole = run_node("torn_elements", {}, {{"uv", {moved_below(0)}}, {"index", {index}}});
  CHECK(share(whole) == 0);
  CHECK(whole.says("0.0 % of the result is torn"));
  const double torn = share(run_node("torn_elements", {}, {{"uv", {moved_below(20)}}, {"index", {index}}}));
  CHECK(torn > 0.03);  // one row of six, without what has only lost a corner
  CHECK(torn < 0.35);
}

TEST_CASE("torn_elements says when no elements are known, and refuses another exemplar") {
  const NodeRun none = run_node("torn_elements", {}, {{"uv", {moved_below(20)}}, {"index", {stones_index(false)}}});
  CHECK(share(none) == 0);
  CHECK(none.says("the analysis knows no elements"));
  const UvMapPtr other = UvMap::make({4, 4}, {30, 20}, std::vector<ExemplarPixel>(16), {});
  CHECK_THROWS_WITH_AS(run_node("torn_elements", {}, {{"uv", {other}}, {"index", {stones_index(true)}}}),
                       doctest::Contains("expected a uv map for the exemplar of \"index\", 240x240, found one for"),
                       Error);
}
