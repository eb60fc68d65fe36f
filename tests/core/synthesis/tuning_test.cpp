#include "core/base/tuning.h"

#include <doctest/doctest.h>

#include "core/synthesis/synthesize.h"
#include "nodes/common/registry.h"
#include "runner/plan/key.h"
#include "tests/core/synthesis/fields.h"
#include "tests/exemplars.h"
#include "tests/overrides.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

Digest key_of_synthesis() {
  GraphNode node;
  node.name = "layout";
  node.type = find_node_type("synthesize");
  return key_of(ingredients_of(node, {}, [](const auto&) { return Digest{}; }));
}

}  // namespace

TEST_CASE("an override takes part in the result and in its cache key, and only as long as it is set") {
  const IndexPtr index = wall_index({72, 64});
  const auto result = [&] { return synthesize(*index, {.size = {90, 80}}, Task())->digest(); };
  const Digest usual = result(), key = key_of_synthesis();
  {
    const TuningOverride other("correction.repeat_penalty", 2);
    CHECK(result() != usual);
    CHECK(key_of_synthesis() != key);
  }
  CHECK(result() == usual);
  CHECK(key_of_synthesis() == key);
}

TEST_CASE("a pass that asks for more than there is room for is an error") {
  const IndexPtr index = wall_index();
  const PaddedLevel exemplar(index->appearance()->levels()[0], false);
  Field field = one_piece({16, 16});
  const CorrectionLevel level = level_of(exemplar, field.size);
  UsagePenalty usage({48, 40}, 0, 1);
  const CorrectionPass pass{.window = &full_window(), .random_candidates = 41, .wanted = whole(field.size)};
  CHECK_THROWS_WITH_AS(correct(field, level, pass, usage, Task()),
                       "a correction pass takes windows of at most 24 pixels and 40 random candidates, found 24 and 41",
                       Error);
}
