#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/resolve/resolve.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

MaterialPtr exemplar(Size size, unsigned seed) {
  return Material::make("m", {{"base_color", noise_image(size, 3, Semantic::base_color, "srgb_texture", seed)},
                              {"roughness", noise_image(size, 1, Semantic::roughness, "raw", seed + 100)}});
}

}  // namespace

TEST_CASE("combine lays materials side by side with a mask, labels and a note") {
  const MaterialPtr a = exemplar({24, 16}, 1), b = exemplar({10, 16}, 2);
  const NodeRun run = run_node("combine", {{"gap", int64_t{6}}}, {{"materials", {a, b}}});
  const MaterialPtr atlas = run.get<Material>("material");
  REQUIRE(atlas->size() == Size{40, 16});
  CHECK(atlas->find("roughness")->read({0, 0, 24, 16}) == a->find("roughness")->pixels());
  CHECK(atlas->find("base_color")->read({30, 0, 10, 16}) == b->find("base_color")->pixels());
  CHECK(run.get<Image>("mask")->read({22, 5, 10, 1}) == std::vector<float>{1, 1, 0, 0, 0, 0, 0, 0, 1, 1});
  CHECK(run.get<Image>("labels")->read({22, 5, 10, 1}) == std::vector<float>{0, 0, 0, 0, 0, 1, 1, 1, 1, 1});
  REQUIRE(run.notes.size() == 1);
  CHECK(run.notes.front() == "2 exemplars in 40x16 pixels");
}

TEST_CASE("a uv map of the atlas resolves to the exemplars' own pixels") {
  const MaterialPtr a = exemplar({16, 16}, 1), b = exemplar({16, 16}, 2);
  const MaterialPtr atlas =
      run_node("combine", {{"gap", int64_t{0}}}, {{"materials", {a, b}}}).get<Material>("material");
  REQUIRE(atlas->size().area() == 512);
  const bool row = atlas->size().width == 32;
  const UvMapPtr uv = UvMap::make({2, 1}, atlas->size(), {{3, 5}, row ? ExemplarPixel{19, 5} : ExemplarPixel{3, 21}});
  const std::vector<float> shown = resolved(*atlas, uv)->find("roughness")->pixels();
  CHECK(shown[0] == a->find("roughness")->read({3, 5, 1, 1}).front());
  CHECK(shown[1] == b->find("roughness")->read({3, 5, 1, 1}).front());
}

TEST_CASE("combine takes a mask for each material, or none") {
  const MaterialPtr a = exemplar({8, 8}, 1);
  const ImagePtr nothing = flat_image({8, 8}, {0}, Semantic::mask), all = flat_image({2, 2}, {1}, Semantic::mask);
  const Params no_gap{{"gap", int64_t{0}}};
  const auto mask = run_node("combine", no_gap, {{"materials", {a, a}}, {"masks", {nothing, all}}}).get<Image>("mask");
  double marked = 0;
  for (const float v : mask->pixels()) marked += double(v);
  CHECK(marked == 64);
  CHECK_THROWS_WITH_AS(run_node("combine", no_gap, {{"materials", {a, a}}, {"masks", {all}}}),
                       "expected 2 masks, one for each material, or none; found 1", Error);
  const ImagePtr wide = flat_image({8, 2}, {1}, Semantic::mask);
  CHECK_THROWS_WITH_AS(run_node("combine", no_gap, {{"materials", {a}}, {"masks", {wide}}}),
                       doctest::Contains("expected an image with the aspect ratio of its material, 8x8 pixels"), Error);
}

TEST_CASE("with a mix map materials lie over each other, and the user hears which shows where") {
  const MaterialPtr a = exemplar({24, 16}, 1), b = exemplar({24, 16}, 2);
  const ImagePtr map = make_image(
      {12, 8}, 1, [](int x, int, int) { return x < 3 ? 0.f : 1.f; }, Semantic::mask);
  const NodeRun run = run_node("combine", {}, {{"materials", {a, b}}, {"mix", {map}}});
  CHECK(run.get<Material>("material")->size() == Size{24, 16});
  CHECK(run.get<Material>("material")->find("roughness")->read({0, 0, 5, 16}) ==
        a->find("roughness")->read({0, 0, 5, 16}));
  CHECK(run.get<Image>("mask")->pixels() == std::vector<float>(24 * 16, 1.f));
  CHECK(run.get<Image>("labels")->read({5, 5, 2, 1}) == std::vector<float>{0, 1});
  CHECK(run.says("the materials cover 25 %, 75 % of 24x16 pixels"));
  const ImagePtr white = flat_image({9, 3}, {1}, Semantic::mask);
  const NodeRun one = run_node("combine", {{"border", "soft"}}, {{"materials", {a, b}}, {"mix", {white}}});
  CHECK(one.says("\"mix\" shows only 1 of the 2 materials"));
  CHECK(one.says("the mix map of 9x3 pixels is stretched to the materials' 24x16"));
  CHECK(one.get<Material>("material")->find("roughness")->pixels() == b->find("roughness")->pixels());
}
