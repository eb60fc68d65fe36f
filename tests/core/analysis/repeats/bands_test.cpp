#include "core/analysis/repeats/bands.h"

#include <cmath>
#include <numbers>
#include <utility>

#include <doctest/doctest.h>

#include "core/analysis/repeats/regularity.h"
#include "core/base/geometry.h"
#include "core/base/hash.h"
#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// As the search for lattices has it, in which bands that repeat, and those that come once, compete with cells.
Lattice bands_found(const FeaturesPtr& features) {
  return find_lattice(*features, 0.08, Task()).lattice;
}

}  // namespace

TEST_CASE("boards with thin joints are courses, few of them too") {
  for (const int height : {23, 74, 105}) {
    CAPTURE(height);
    const Lattice l = bands_found(plain_features(make_image({192, 192}, 1, [&](int x, int y, int) {
      const int row = (y + 31) / height, end = int(below(uint32_t(random_bits(8, row)), 300));
      const bool joint = (y + 31) % height < 2 || wrap(x - end, 300) < 2;
      return float(joint ? 0 : 0.6 + 0.3 * unit_double(random_bits(7, y / 2, (x + 17 * y) / 30)));
    })));
    REQUIRE(l.rank == 1);
    CHECK(l.first.y() == doctest::Approx(height).epsilon(0.02));
  }
}

TEST_CASE("a stripe painted on a wall makes courses as high as the exemplar") {
  const auto wall = [](double grain, bool across) {
    return make_image({192, 192}, 1, [=](int x, int y, int) {
      const int at = across ? x : y;
      return float((at >= 120 && at < 165 ? 0.2 : 0.7) + grain * unit_double(random_bits(7, x / 3, y / 3)));
    });
  };
  for (const bool wraps : {false, true})
    for (const bool across : {false, true}) {
      CAPTURE(wraps);
      CAPTURE(across);
      const Lattice l = bands_found(plain_features(wall(0.2, across), wraps));
      REQUIRE(l.rank == 1);
      CHECK(l.first.x() == (across ? 192 : 0));
      CHECK(l.first.y() == (across ? 0 : 192));
      CHECK(l.certainty > 0.6);
    }
  // A shade of it that is lost in the grain does not.
  CHECK(bands_found(plain_features(wall(4, false))).rank == 0);
}

TEST_CASE("many courses say more than a few whose shades happen to agree") {
  for (const auto& [height, joint] : {std::pair{8, 0.0}, std::pair{16, 0.2}})
    for (int seed = 0; seed < 40; seed++) {
      CAPTURE(height);
      CAPTURE(seed);
      const Lattice l = bands_found(plain_features(make_image({160, 160}, 1, [&](int x, int y, int) {
        const double shade = 0.3 + 0.5 * unit_double(random_bits(5, (y + 5) / height, seed));
        const double grain = 0.15 * unit_double(random_bits(6, x, y, seed));
        return float((y + 5) % height < 2 ? joint : shade + grain);
      })));
      REQUIRE(l.rank == 1);
      CHECK(l.first.y() == doctest::Approx(height).epsilon(0.02));
    }
}

TEST_CASE("a few shades of a ground are no courses, painted stripes are") {
  const auto ground = [](bool painted) {
    return plain_features(make_image({240, 240}, 1, [painted](int x, int y, int) {
      double grain = 0;
      for (int k = 0; k < 9; k++) grain += unit_double(random_bits(6, (x + k % 3) / 3, (y + k / 3) / 3)) / 9;
      const double shade = std::cos(y * 2 * std::numbers::pi / 80), stripe = y % 80 < 40 ? 1 : -1;
      return float(0.2 * (painted ? stripe : shade) + grain);
    }));
  };
  CHECK(bands_found(ground(true)).rank == 1);
  CHECK(bands_found(ground(false)).rank == 0);
}

TEST_CASE("stripes aslant repeat with their colours, not with their edges, which are alike on both sides") {
  constexpr int period = 64;
  for (const auto& [spot, seed] : {std::pair{6, 1}, {10, 2}, {24, 1}}) {
    CAPTURE(spot);
    const auto spots = [=](double x, double y) {
      const int i = int(x / spot), j = int(y / spot);
      const double u = x / spot - i, v = y / spot - j;
      const auto at = [&](int k, int l) { return unit_double(random_bits(uint64_t(seed), i + k, j + l)); };
      return (1 - v) * ((1 - u) * at(0, 0) + u * at(1, 0)) + v * ((1 - u) * at(0, 1) + u * at(1, 1));
    };
    const Lattice l = bands_found(plain_features(make_image({256, 256}, 1, [&](int x, int y, int) {
      const double stripe = (x + y) % period < period / 2 ? 1 : 0;
      return float(stripe + 0.1 * unit_double(random_bits(9, x, y)) + 0.3 * spots(x, y));
    })));
    REQUIRE(l.rank == 2);
    for (const Vector2d& step : {l.first, l.second})
      CHECK(std::abs(step.sum() / period - std::round(step.sum() / period)) < 0.05);
  }
}

TEST_CASE("a stripe aslant that comes once around an exemplar that tiles goes on, a soft one does not") {
  const auto striped = [](bool painted, double rise) {
    return plain_features(make_image({128, 128}, 1,
                                     [=](int x, int y, int) {
                                       const double across = wrap(y + int(rise * x), 128) / 128.0;
                                       const double soft = std::cos(across * 2 * std::numbers::pi);
                                       const double grain = 0.4 * unit_double(random_bits(6, x / 2, y / 2));
                                       return float(0.3 * (painted ? (across < 0.5 ? 1 : -1) : soft) + grain);
                                     }),
                          true);
  };
  for (const double rise : {1.0, -1.0}) {
    CAPTURE(rise);
    const Lattice found = bands_found(striped(true, rise));
    REQUIRE(found.rank == 2);
    CHECK(found.first == Vector2d{64, -64 * rise});
    CHECK(found.second == Vector2d{0, 128});
  }
  CHECK(bands_found(striped(false, 1)).rank == 0);
}
