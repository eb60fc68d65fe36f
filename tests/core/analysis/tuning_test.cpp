#include "core/base/tuning.h"

#include <doctest/doctest.h>

#include "core/analysis/repeats/regularity.h"
#include "core/base/hash.h"
#include "tests/drawn_wall.h"
#include "tests/overrides.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

Digest lattice_of(const ImagePtr& image) {
  Hasher h;
  find_lattice(*plain_features(image), 0.1, Task()).lattice.add_to(h);
  return h.digest();
}

/// Courses that come again, but no bricks.
Digest bands() {
  return lattice_of(DrawnWall({160, 150}).image());
}

/// Bricks in a bond.
Digest cells() {
  return lattice_of(wall({96, 80}));
}

/// What pixels look like.
Digest looks() {
  const AppearancePtr appearance = DrawnWall({160, 150}).appearance();
  Hasher h;
  for (const AppearanceLevel& level : appearance->levels())
    h.bytes(level.vectors.data(), level.vectors.size() * sizeof(level.vectors[0]));
  return h.digest();
}

struct Nudge {
  const char* name;
  double value;
};

}  // namespace

TEST_CASE("another value of a constant changes what is found of an exemplar, and only as long as it is set") {
  struct Found {
    Digest (*of)();
    std::vector<Nudge> changed_by;
  };
  for (const Found& found :
       {Found{bands, {{"bands.multiple", 4.5}, {"bands.deviations", 0.9}, {"lag_correlation.grain", 2}}},
        Found{cells, {{"cell_search.farthest", 2}, {"cell_search.same_area", 3}, {"near_peaks.most_peaks", 2}}},
        Found{looks, {{"planes.least_deviation", 1}, {"appearance_space.most_samples", 200}}}}) {
    const Digest usual = found.of();
    for (const Nudge& n : found.changed_by) {
      CAPTURE(std::string(n.name));
      const TuningOverride other(n.name, n.value);
      CHECK(found.of() != usual);
    }
    CHECK(found.of() == usual);
  }
}
