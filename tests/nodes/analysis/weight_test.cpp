#include <doctest/doctest.h>

#include "core/exemplar/features.h"
#include "tests/exemplars.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("weights of usual maps that a material lacks do nothing, and are told; others are mistakes") {
  const MaterialPtr material = Material::of(wall({32, 32}));
  const NodeRun plain = run_node("weight", {}, {{"material", {material}}});
  const NodeRun more =
      run_node("weight", {{"weights", NumberMap{{"metallic", {2}}, {"base_color", {1}}}}}, {{"material", {material}}});
  CHECK(more.says("the material has no metallic; its weight does nothing"));
  CHECK(more.get<Features>("features")->digest() == plain.get<Features>("features")->digest());
  CHECK(contains(error_of("weight", {{"weights", NumberMap{{"metalic", {2}}}}}, {{"material", {material}}}),
                 "there is no map \"metalic\""));
}

TEST_CASE("what an exemplar shows only once is warned of, unless a mask was drawn") {
  const auto plaster = [](bool stained) {
    return Material::of(make_image(
        {240, 160}, 3,
        [stained](int x, int y, int channel) {
          const bool stain = stained && (x - 150) * (x - 150) + (y - 60) * (y - 60) < 144;
          return stain ? (channel == 0 ? 0.8f : 0.1f) : 0.3f + 0.4f * float(unit_double(random_bits(1, x, y)));
        },
        Semantic::base_color, "srgb_texture"));
  };
  CHECK(run_node("weight", {}, {{"material", {plaster(true)}}}).says("only once"));
  CHECK_FALSE(run_node("weight", {}, {{"material", {plaster(false)}}}).says("only once"));
  const ImagePtr mask = make_image({240, 160}, 1, [](int x, int, int) { return x < 120 ? 1.f : 0.f; });
  CHECK_FALSE(run_node("weight", {}, {{"material", {plaster(true)}}, {"mask", {mask}}}).says("only once"));
}
