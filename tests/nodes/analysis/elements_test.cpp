#include <set>

#include <doctest/doctest.h>

#include "core/analysis/elements/find_elements.h"
#include "tests/drawn_stones.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

FeaturesPtr noise() {
  return plain_features(
      make_image({96, 96}, 1, [](int x, int y, int) { return float(unit_double(random_bits(2, x, y))); }));
}

}  // namespace

TEST_CASE("elements gives the features their elements, and a picture with a value for each") {
  const FeaturesPtr features = plain_features(DrawnStones({128, 128}).image(), true);
  const NodeRun run = run_node("elements", {}, {{"features", {features}}});
  const ElementsPtr found = run.get<Features>("features")->elements();
  REQUIRE(found);
  const std::vector<float> labels = run.get<Image>("labels")->pixels();
  CHECK(std::set<float>(labels.begin(), labels.end()).size() == size_t(found->count));
  for (size_t i = 0; i < labels.size(); i++)
    REQUIRE(labels[i] == doctest::Approx(found->at[i] / double(found->count - 1)));
}

TEST_CASE("an exemplar without elements passes through unchanged") {
  const NodeRun run = run_node("elements", {}, {{"features", {noise()}}});
  CHECK(run.get<Features>("features")->digest() == noise()->digest());
  for (const float v : run.get<Image>("labels")->pixels()) REQUIRE(v == 0);
}

TEST_CASE("what certainty is asked for decides") {
  const auto found = [&](const Params& params) {
    return run_node("elements", params, {{"features", {noise()}}}).get<Features>("features")->elements() != nullptr;
  };
  CHECK(found({{"least_certainty", 0.0}}));
  CHECK_FALSE(found({}));
}

TEST_CASE("without a lattice elements may be less sure") {
  const std::vector<float> stones = DrawnStones({128, 128}).image()->pixels();
  const FeaturesPtr plain = plain_features(make_image({128, 128}, 1,
                                                      [&](int x, int y, int) {
                                                        return 0.2f * stones[size_t(y) * 128 + size_t(x)] +
                                                               0.8f * float(unit_double(random_bits(2, x, y)));
                                                      }),
                                           true);
  const Repeats repeats = Lattice{2, {16, 0}, {0, 16}, 0.9};
  const double certainty = find_elements(*plain, Task())->certainty;
  REQUIRE(certainty > 0.1);
  REQUIRE(certainty < 0.8);
  const auto found = [&](const FeaturesPtr& features, double least) {
    const NodeRun run = run_node("elements", {{"least_certainty", least}}, {{"features", {features}}});
    return run.get<Features>("features")->elements() != nullptr;
  };
  const double more = certainty / 0.8;
  CHECK(found(plain, more));
  CHECK_FALSE(found(plain->with(repeats), more));
  CHECK(found(plain->with(repeats), certainty));
}
