#include <algorithm>

#include <doctest/doctest.h>

#include "core/analysis/repeats/regularity.h"
#include "core/base/hash.h"
#include "tests/exemplars.h"

/// Exemplars that are copies of one part, side by side.
using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// Ground of round spots, one above the other, which comes again after `period` pixels.
double ground(int x, int y, int period) {
  double value = 0;
  for (int i = 0; i < 200; i++) {
    const uint64_t r = random_bits(9, i);
    const auto apart = [&](int at, uint64_t centre) {
      const int d = wrap(at - int(centre % uint64_t(period)), period);
      return std::min(d, period - d);
    };
    const int dx = apart(x, r), dy = apart(y, r >> 20);
    if (dx * dx + dy * dy < 30 + int(r >> 40) % 60) value = unit_double(r);
  }
  return value;
}

template <typename Drawn>
Lattice found(Size size, const Drawn& drawn, bool wraps = true) {
  const FeaturesPtr features =
      plain_features(make_image(size, 1, [&](int x, int y, int) { return float(drawn(x, y)); }), wraps);
  return find_lattice(*features, 0.08, Task()).lattice;
}

}  // namespace

TEST_CASE("copies of ground have no lattice, whether exact or with grain of their own") {
  for (const double grain : {0.0, 0.2}) {
    CAPTURE(grain);
    const auto drawn = [grain](int x, int y) { return ground(x, y, 128) + grain * unit_double(random_bits(9, x, y)); };
    CHECK(found({256, 256}, drawn).rank == 0);
    CHECK(found({128, 256}, drawn).rank == 0);
    CHECK(found({300, 280}, drawn, false).rank == 0);
  }
}

TEST_CASE("copies smaller than 128 pixels are a motif, and so are those with a line between them") {
  const Lattice small = found({192, 192}, [](int x, int y) { return ground(x, y, 96); });
  CHECK(small.rank == 2);
  CHECK(small.cell_area() == doctest::Approx(96 * 96));
  const Lattice tiles =
      found({256, 256}, [](int x, int y) { return ground(x, y, 128) + (x % 128 < 3 || y % 128 < 3 ? 0.8 : 0); });
  CHECK(tiles.rank == 2);
  CHECK(tiles.cell_area() == doctest::Approx(128 * 128));
}

TEST_CASE("copies of tiles are tiles, each of its own shade") {
  const Lattice l = found({256, 256}, [](int x, int y) {
    const double shade = 0.4 * unit_double(random_bits(1, x % 128 / 16, y % 128 / 16));
    return shade + 0.1 * unit_double(random_bits(2, x % 128, y % 128)) + (x % 16 < 2 || y % 16 < 2 ? 0.6 : 0);
  });
  CHECK(l.rank == 2);
  CHECK(l.cell_area() == doctest::Approx(16 * 16));
}
