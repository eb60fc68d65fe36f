#include "core/metrics/wrap_seam.h"

#include <doctest/doctest.h>

#include "core/base/hash.h"
#include "tests/core/metrics/textures.h"
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

TEST_CASE("wrap seams show in a cut texture, sharp or blurred, and not in one that wraps or has no structure") {
  const auto seam = [](const Planes& planes) {
    return wrap_seam(*Image::from_floats({.size = planes.size, .channels = planes.channels}, planes.values));
  };
  const auto ramp = [](Size size) {
    Planes out = Planes::zeros(size, 1);
    for (int i = 0; i < size.area(); i++)
      out.values[i] = float(i % size.width) / float(size.width) + 0.05f * float(unit_double(random_bits(3, i)));
    return out;
  };
  const double cut = seam(ramp({64, 64})).x, blurred_cut = seam(blurred(ramp({64, 64}), 1, Beyond::mirrored, Task())).x;
  CHECK(cut > 10);
  CHECK(blurred_cut > cut);
  CHECK(seam(ramp({64, 64})).y == doctest::Approx(1).epsilon(0.1));
  CHECK(seam(shuffled(ramp({64, 64}), 5)).x == doctest::Approx(1).epsilon(0.2));
  CHECK(seam(random_blocks(ramp({64, 64}), {64, 64}, 16, 2)).x > 2);
}
