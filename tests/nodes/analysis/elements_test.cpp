#include <set>

#include <doctest/doctest.h>

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
