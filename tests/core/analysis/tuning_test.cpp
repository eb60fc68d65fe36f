#include "core/base/tuning.h"

#include <doctest/doctest.h>

#include "core/analysis/courses/coursing.h"
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

/// Courses, and the joints across them.
Digest courses() {
  const Coursing coursing = find_coursing(*DrawnWall({160, 150}).appearance(), Task());
  Hasher h;
  for (const ExemplarCourse& c : coursing.courses) {
    h.add(c.begin).add(c.end);
    for (const float joint : c.joint) h.add(joint);
  }
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
        Found{courses,
              {{"coursing.smallest_period", 30},
               {"bed_joints.unlike_sections", 2},
               {"head_joints.surely_bed", 0},
               {"planes.least_deviation", 1},
               {"appearance_space.most_samples", 200}}}}) {
    const Digest usual = found.of();
    for (const Nudge& n : found.changed_by) {
      CAPTURE(std::string(n.name));
      const TuningOverride other(n.name, n.value);
      CHECK(found.of() != usual);
    }
    CHECK(found.of() == usual);
  }
}
