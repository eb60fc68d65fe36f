#include <doctest/doctest.h>

#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

MaterialPtr make(const Params& params, std::vector<Value> images, std::vector<Value> material = {}) {
  std::map<std::string, std::vector<Value>> inputs = {{"images", std::move(images)}};
  if (!material.empty()) inputs["material"] = std::move(material);
  return run_node("make_material", params, inputs).get<Material>("material");
}

}  // namespace

TEST_CASE("images become maps named after what they mean, or as asked") {
  const ImagePtr height = noise_image({4, 4}, 1, Semantic::height), data = noise_image({4, 4}, 1);
  CHECK(make({}, {height, data})->map_names() == "height, data");
  const MaterialPtr named =
      make({{"name", "stone"}, {"names", Texts{"height", "mask_moss"}}, {"semantics", Texts{"keep", "mask"}}},
           {height, data});
  CHECK(named->name() == "stone");
  CHECK(named->map_names() == "height, mask_moss");
  CHECK(named->find("height") == height);
  CHECK(named->find("mask_moss")->info().semantic == Semantic::mask);
  CHECK(named->find("mask_moss")->pixels() == data->pixels());
}

TEST_CASE("an image takes the place of a material's map of the same name") {
  const ImagePtr height = noise_image({4, 4}, 1, Semantic::height), other = noise_image({8, 8}, 1, Semantic::height);
  const ImagePtr normal = noise_image({4, 4}, 3, Semantic::normal);
  const MaterialPtr material = Material::make("m", {{"height", height}, {"normal", normal}});
  const MaterialPtr changed = make({}, {other}, {material});
  CHECK(changed->name() == "m");
  CHECK(changed->map_names() == "height, normal");
  CHECK(changed->find("height") == other);
  CHECK(changed->find("normal") == normal);
}

TEST_CASE("make_material warns of maps that it makes the smaller ones, and of no others") {
  const auto map = [](int side, Semantic semantic) { return noise_image({side, side}, 1, semantic); };
  const auto notes = [](std::vector<Value> images, const MaterialPtr& base) {
    return run_node("make_material", {}, {{"images", std::move(images)}, {"material", {base}}}).notes;
  };
  const MaterialPtr mixed =
      Material::make("m", {{"base_color", map(8, Semantic::base_color)}, {"roughness", map(4, Semantic::roughness)}});
  CHECK(notes({map(8, Semantic::height)}, mixed).empty());
  CHECK(notes({map(2, Semantic::height)}, mixed) ==
        std::vector<std::string>{"warning: the material has 8x8 pixels, the size of its largest map; height (2x2) is "
                                 "scaled up to that. If this is not intended, bring the maps to one size"});
  const std::vector<std::string> larger = notes({map(16, Semantic::height)}, mixed);
  REQUIRE(larger.size() == 1);
  CHECK(larger.front().find("; base_color (8x8), roughness (4x4) are scaled up") != std::string::npos);
}

TEST_CASE("make_material says what is wrong with names and semantics") {
  const ImagePtr data = noise_image({2, 2}, 1);
  CHECK_THROWS_WITH_AS(make({}, {data, data}), doctest::Contains("found \"data\" twice"), Error);
  CHECK_THROWS_WITH_AS(make({{"names", Texts{"a"}}}, {data, data}),
                       doctest::Contains("expected 2 texts, one for each image, or none; found 1"), Error);
  CHECK_THROWS_WITH_AS(make({{"names", Texts{""}}}, {data}), doctest::Contains("an empty one"), Error);
  CHECK_THROWS_WITH_AS(make({{"semantics", Texts{"hight"}}}, {data}), doctest::Contains("found \"hight\""), Error);
}
