#include <doctest/doctest.h>

#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("get_map gives the very map") {
  const ImagePtr height = noise_image({4, 4}, 1, Semantic::height);
  const MaterialPtr material =
      Material::make("m", {{"normal", noise_image({4, 4}, 3, Semantic::normal)}, {"height", height}});
  const NodeRun run = run_node("get_map", {{"map", "height"}}, {{"material", {material}}});
  CHECK(run.get<Image>("image") == height);
  CHECK_THROWS_WITH_AS(run_node("get_map", {{"map", "color"}}, {{"material", {material}}}),
                       "there is no map \"color\"; the material has normal, height", Error);
}
