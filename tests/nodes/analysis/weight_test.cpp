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
