#include "core/base/tuning.h"

#include <algorithm>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "core/synthesis/synthesize.h"
#include "nodes/common/registry.h"
#include "runner/engine/key.h"
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

/// A wall as an irregular exemplar, or with its lattice.
Digest result(bool regular) {
  constexpr Size size{72, 64};
  const Lattice lattice = regular ? Lattice{2, {16, 0}, {8, 8}, 0.9} : Lattice{};
  const FeaturesPtr features = Features::make(size, {{wall(size), {1.0, 1.0, 1.0}}}, false, lattice);
  const IndexPtr index = make_index(make_appearance(*features, {}, {}, Task()), 3, Task());
  return synthesize(*index, {.size = {96, 80}}, Task())->digest();
}

struct Nudge {
  const char* name;
  double value;
  bool regular;
};

}  // namespace

TEST_CASE("another value of a constant changes the result and its cache key, and only as long as it is set") {
  const Digest usual[] = {result(false), result(true)};
  const Digest key = key_of_synthesis();
  for (const Nudge& n : {Nudge{"correction.repeat_penalty", 2, false}, Nudge{"initialize.free_draws", 1, false},
                         Nudge{"initialize.blocks_per_side", 3, false}, Nudge{"piece_limits.large", 0.02, false},
                         Nudge{"usage_penalty.gain", 0.9, false}, Nudge{"proximity_penalty.far_reach", 1, false},
                         Nudge{"expansion.edge", 3000, true}, Nudge{"seams.fair_pressure", 300, true}}) {
    CAPTURE(std::string(n.name));
    const Override other(n.name, n.value);
    CHECK(result(n.regular) != usual[n.regular]);
    CHECK(key_of_synthesis() != key);
  }
  CHECK(result(false) == usual[0]);
  CHECK(result(true) == usual[1]);
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
