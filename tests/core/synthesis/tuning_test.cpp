#include "core/base/tuning.h"

#include <algorithm>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "core/synthesis/synthesize.h"
#include "nodes/common/registry.h"
#include "runner/plan/key.h"
#include "tests/core/synthesis/fields.h"
#include "tests/drawn_wall.h"
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

/// Spots of several sizes and colours.
ImagePtr spots(Size size) {
  return make_image(
      size, 3,
      [](int x, int y, int c) {
        double sum = 0;
        for (int octave = 0; octave < 4; octave++)
          sum += (octave + 1) * unit_double(random_bits(21 + octave, x >> octave, y >> octave, octave < 2 ? c : 0));
        return float(sum / 10);
      },
      Semantic::base_color, "srgb_texture");
}

enum class Shown : uint8_t { irregular_wall, wall_with_lattice, drawn_wall, spots_at_best };

FeaturesPtr features_of(Shown shown) {
  const DrawnWall drawn({160, 150});
  switch (shown) {
    case Shown::irregular_wall:
      return plain_features(wall({72, 64}));
    case Shown::wall_with_lattice:
      return plain_features(wall({72, 64}))->with(Lattice{2, {16, 0}, {8, 8}, 0.9});
    case Shown::drawn_wall:
      return plain_features(drawn.image())->with(drawn.lattice());
    case Shown::spots_at_best:
      break;
  }
  return plain_features(spots({160, 160}));
}

Digest result(Shown shown) {
  const FeaturesPtr features = features_of(shown);
  const Size size = features->size();
  const IndexPtr index = make_index(make_appearance(*features, {}, {}, Task()), 3, Task());
  SynthesisOptions options{.size = {size.width * 5 / 4, size.height * 5 / 4}};
  if (shown == Shown::spots_at_best) options.quality = Quality::best;
  return synthesize(*index, options, Task())->digest();
}

struct Nudge {
  const char* name;
  double value;
};

}  // namespace

TEST_CASE("another value of a constant changes the result and its cache key, and only as long as it is set") {
  struct Result {
    Shown shown;
    std::vector<Nudge> changed_by;
  };
  const Digest key = key_of_synthesis();
  for (const Result& r :
       {Result{Shown::irregular_wall,
               {{"correction.repeat_penalty", 2},
                {"initialize.free_draws", 1},
                {"initialize.blocks_per_side", 3},
                {"piece_limits.large", 0.02},
                {"usage_penalty.gain", 0.9},
                {"proximity_penalty.far_reach", 1}}},
        Result{Shown::wall_with_lattice,
               {{"expansion.edge", 3000}, {"seams.fair_pressure", 300}, {"lattice.smallest_resolved", 1.5}}},
        Result{Shown::drawn_wall,
               {{"alignment.worthwhile", 30}, {"course_prices.own", 0}, {"coursing.smallest_period", 30}}},
        Result{Shown::spots_at_best,
               {{"coherence_repair.incoherent", 1},
                {"k_coherence.rounds", 2},
                {"patches.random_places", 0},
                {"graphcut_repair.worse", 3}}}}) {
    const Digest usual = result(r.shown);
    for (const Nudge& n : r.changed_by) {
      CAPTURE(int(r.shown));
      CAPTURE(std::string(n.name));
      const Override other(n.name, n.value);
      CHECK(result(r.shown) != usual);
      CHECK(key_of_synthesis() != key);
    }
    CHECK(result(r.shown) == usual);
  }
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
