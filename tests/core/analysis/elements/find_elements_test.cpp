#include "core/analysis/elements/find_elements.h"

#include <atomic>
#include <map>

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include "core/analysis/elements/partition.h"
#include "core/base/error.h"
#include "tests/drawn_stones.h"
#include "tests/drawn_wall.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

const Task task;

/// The share of the pixels whose element is the one that most of its true element's pixels belong to, and which holds
/// mostly pixels of that.
double agreement(const Elements& found, const Elements& truth) {
  std::map<std::pair<uint16_t, uint16_t>, int64_t> both;
  for (size_t i = 0; i < truth.at.size(); i++) both[{truth.at[i], found.at[i]}]++;
  std::map<uint16_t, std::pair<int64_t, uint16_t>> of_truth, of_found;
  for (const auto& [pair, count] : both) {
    of_truth[pair.first] = std::max(of_truth[pair.first], {count, pair.second});
    of_found[pair.second] = std::max(of_found[pair.second], {count, pair.first});
  }
  int64_t agreed = 0;
  for (const auto& [element, most] : of_truth)
    if (of_found[most.second].second == element) agreed += most.first;
  return double(agreed) / double(truth.at.size());
}

FeaturesPtr noise_features(Size size) {
  return plain_features(
      make_image(size, 1, [](int x, int y, int) { return float(unit_double(random_bits(4, x, y))); }));
}

/// Square cells with lines between them; `dashes`: with a short line in each cell that ends nowhere.
Partition cells(int across, bool dashes) {
  constexpr int side = 16;
  const Size size{across * side, across * side};
  std::vector<uint8_t> relief;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const int u = x % side, v = y % side;
      const bool line = u == 0 || v == 0 || (dashes && u == side / 2 && v > 5 && v < 12);
      relief.push_back(uint8_t((line ? 160 : 20) + 40 * unit_double(random_bits(3, x, y))));
    }
  return partitioned(relief, size, true, 1);
}

}  // namespace

TEST_CASE("many elements are surer than few, and those without lines inside surer than those with") {
  CHECK(cells(8, false).regions.count == 64);
  CHECK(cells(8, false).confidence() > 1.2 * cells(3, false).confidence());
  CHECK(cells(8, true).confidence() < 0.9 * cells(8, false).confidence());
  CHECK(cells(8, true).stray > 0.02);
  CHECK(cells(8, false).stray < 0.01);
}

TEST_CASE("stones are told apart by their joints, dark or light, at several sizes") {
  for (const Size size : {Size{128, 128}, Size{200, 160}, Size{520, 400}})
    for (const bool light : {false, true}) {
      CAPTURE(size.width);
      CAPTURE(light);
      const DrawnStones stones(size);
      ImagePtr image = stones.image();
      if (light)
        image = make_image(size, 1, [of = image](int x, int y, int) {
          float v = 0;
          of->read({x, y, 1, 1}, &v);
          return 1 - v;
        });
      const ElementsPtr found = find_elements(*plain_features(image, true), task);
      REQUIRE(found);
      CHECK(found->size == size);
      CHECK(found->certainty > 0.3);
      CHECK(agreement(*found, stones.elements()) > 0.85);
    }
}

TEST_CASE("where the exemplar tiles, elements go on around its borders") {
  const DrawnStones stones({160, 160});
  const ElementsPtr around = find_elements(*plain_features(stones.image(), true), task);
  const ElementsPtr cut = find_elements(*plain_features(stones.image(), false), task);
  REQUIRE(around);
  REQUIRE(cut);
  CHECK(whole_elements(*around, true) == around->count);
  CHECK(whole_elements(*cut, false) < cut->count);
  CHECK(around->count < cut->count);
}

TEST_CASE("noise and smooth slopes have no elements that are sure") {
  const ElementsPtr noise = find_elements(*noise_features({160, 128}), task);
  CHECK((!noise || noise->certainty < 0.2));
  const ElementsPtr slope =
      find_elements(*plain_features(make_image({128, 128}, 1, [](int x, int, int) { return float(x) / 128; })), task);
  CHECK((!slope || slope->certainty < 0.2));
}

TEST_CASE("tiny exemplars have no elements, and do not crash") {
  for (const Size size : {Size{1, 1}, Size{5, 3}, Size{15, 40}, Size{16, 16}})
    for (const bool wraps : {false, true}) {
      const ImagePtr image =
          make_image(size, 2, [](int x, int y, int c) { return float(unit_double(random_bits(c, x, y))); });
      const ElementsPtr found = find_elements(*plain_features(image, wraps), task);
      if (!found) continue;
      CHECK(found->at.size() == size_t(size.area()));
      for (const uint16_t e : found->at) CHECK(e < found->count);
    }
}

TEST_CASE("elements do not depend on the number of threads") {
  const FeaturesPtr features = plain_features(DrawnStones({150, 130}).image(), true);
  const auto found = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] { return find_elements(*features, task); });
  };
  CHECK(found(1)->at == found(4)->at);
}

TEST_CASE("looking for elements can be cancelled") {
  const std::atomic<bool> cancelled{true};
  const FeaturesPtr features = plain_features(DrawnStones({96, 96}).image());
  CHECK_THROWS_AS(find_elements(*features, Task(&cancelled, {})), Cancelled);
}
