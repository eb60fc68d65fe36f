#include "core/metrics/wrap_seam.h"

#include <doctest/doctest.h>

#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("an image that tiles has a wrap seam of about one, one that does not has more") {
  const auto triangle = [](int v, int period) { return float(std::abs(v % period - period / 2)) / float(period); };
  const ImagePtr image = make_image({64, 40}, 1, [&](int x, int y, int) { return triangle(x, 16) + 0.02f * float(y); });
  const WrapSeam seam = wrap_seam(*image);
  CHECK(seam.x == doctest::Approx(1).epsilon(0.05));
  CHECK(seam.y > 20);
}

TEST_CASE("flat images and single rows have no wrap seam") {
  CHECK(wrap_seam(*make_image({8, 8}, 3, [](int, int, int) { return 0.5f; })).x == doctest::Approx(1));
  CHECK(wrap_seam(*make_image({8, 1}, 1, [](int x, int, int) { return float(x); })).y == 1);
}
