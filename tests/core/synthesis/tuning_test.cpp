#include "core/base/tuning.h"

#include <algorithm>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "core/synthesis/state/patches.h"
#include "core/synthesis/synthesize.h"
#include "nodes/common/registry.h"
#include "runner/engine/key.h"
#include "tests/core/synthesis/fields.h"
#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

const TuningConstant& constant(const std::string& name) {
  const auto all = tuning_constants();
  const auto at = std::ranges::find_if(all, [&](const TuningConstant* c) { return c->name == name; });
  REQUIRE(at != all.end());
  return **at;
}

/// Another value for a while: the other tests of this process must not notice.
class Override {
 public:
  Override(const std::string& name, double value) : name_(name), usual_(constant(name).number()) {
    override_tuning(name, value);
  }
  ~Override() { override_tuning(name_, usual_); }
  Override(const Override&) = delete;
  Override& operator=(const Override&) = delete;

 private:
  std::string name_;
  double usual_;
};

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

TEST_CASE("constants of the synthesis are listed under the names of their files") {
  std::vector<std::string> groups;
  for (const TuningConstant* c : tuning_constants()) groups.push_back(c->name.substr(0, c->name.find('.')));
  for (const char* file :
       {"alignment", "coherence_repair", "control", "correction", "course_layout", "course_prices", "exemplar_courses",
        "expansion", "graphcut_repair", "initialize", "labels", "patches", "piece_limits", "piece_relocation",
        "proximity_penalty", "seams", "usage_penalty", "window_coherence"}) {
    CAPTURE(file);
    CHECK(std::ranges::count(groups, file) > 0);
  }
}

TEST_CASE("constants of the synthesis say what both directions bring, and in which unit") {
  for (const TuningConstant* c : tuning_constants()) {
    if (c->name.starts_with("test_")) continue;  // of another test
    CAPTURE(c->name);
    CHECK(!c->unit.empty());
    CHECK(c->trades.size() > 10);
  }
}

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

TEST_CASE("constants that do not suit one another are errors") {
  const IndexPtr index = wall_index();
  const PaddedLevel exemplar(index->appearance()->levels()[0], false);
  Field field = one_piece({16, 16});
  const CorrectionLevel level = level_of(exemplar, field.size);
  UsagePenalty usage({48, 40}, 0, 1);
  ExpansionGround ground(field, level);
  {
    const Override other("patches.near", Patches::half);
    CHECK_THROWS_WITH_AS(Patches(ground, usage, 1), "tuning: patches.near must be above 6, strides above 0", Error);
  }
  const CorrectionPass pass{.window = &full_window(), .random_candidates = 41, .wanted = whole(field.size)};
  CHECK_THROWS_WITH_AS(correct(field, level, pass, usage, Task()),
                       "a correction pass takes windows of at most 24 pixels and 40 random candidates, found 24 and 41",
                       Error);
}
