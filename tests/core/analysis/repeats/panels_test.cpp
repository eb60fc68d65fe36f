#include <algorithm>
#include <array>
#include <cstdlib>
#include <iterator>

#include <doctest/doctest.h>

#include "core/analysis/repeats/regularity.h"
#include "core/analysis/space/weighting.h"
#include "core/base/hash.h"
#include "core/procedural/pattern.h"
#include "tests/exemplars.h"

/// Exemplars that are panels, and tile.
using namespace terrazzo;
using namespace terrazzo::test;

namespace {

Lattice found(const FeaturesPtr& features) {
  return find_lattice(*features, 0.08, Task()).lattice;
}

}  // namespace

TEST_CASE("panels of many heights between posts are one cell, though their joints come in steps") {
  const std::array<int, 7> joints = {0, 48, 72, 96, 144, 168, 192};
  const auto across = [&](int at) {
    const auto next = std::ranges::upper_bound(joints, at);
    return std::min(at - *std::prev(next), *next - 1 - at);
  };
  const FeaturesPtr f = plain_features(make_image({192, 192}, 1,
                                                  [&](int x, int y, int) {
                                                    const int post = std::min(x, 191 - x);
                                                    const int depth = std::min({across(y), post, std::abs(post - 14)});
                                                    const double noise = unit_double(random_bits(4, x, y));
                                                    return float((depth < 2 ? 0.1 : 0.7) + 0.1 * noise);
                                                  }),
                                       true);
  CHECK(found(f).is_single_cell({192, 192}));
}

TEST_CASE("panels in a row of which some are two wide come again as a whole") {
  const auto row = [](bool wide) {
    return plain_features(make_image({256, 128}, 1,
                                     [=](int x, int y, int) {
                                       const bool closed = wide && (x / 32 == 2 || x / 32 == 4 || x / 32 == 7);
                                       const bool joint = x % 32 >= 30 && !closed;
                                       const double noise = unit_double(random_bits(4, x, y));
                                       return float((y < 12 ? 0.1 : joint ? 0.3 : 0.7) + 0.1 * noise);
                                     }),
                          true);
  };
  const Lattice even = found(row(false));
  CHECK(even.cell_area() == doctest::Approx(32 * 128).epsilon(0.01));
  CHECK(even.fits({32, 128}, true, true));
  CHECK(found(row(true)).is_single_cell({256, 128}));
}

TEST_CASE("boards whose joints are long lines, too, keep their courses, which their elements tell") {
  PatternSpec spec;
  spec.type = "planks";
  spec.size = {512, 512};
  const FoundLattice told = find_lattice(*weighted_features(*make_pattern(spec, Task()), {}, true), 0.08, Task());
  CHECK(told.by_lines.rank == 2);
  CHECK(told.lattice.rank == 1);
  CHECK(told.lattice.first.y() == doctest::Approx(512 / 6.0).epsilon(0.01));
}
