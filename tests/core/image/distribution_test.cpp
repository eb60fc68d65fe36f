#include "core/image/distribution.h"

#include <limits>

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include "core/base/hash.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("a distribution does not depend on which thread saw which values") {
  // Every strip has values that no other has, so threads see different ones.
  const ImagePtr image = make_image({40, 640}, 2, [](int x, int y, int c) {
    return float(y / 32) + 0.5f * float(unit_double(random_bits(2, x, y, c)));
  });
  const auto describe = [&](int threads) {
    Hasher h;
    tbb::task_arena(threads).execute([&] {
      for (const Distribution& d : Distribution::of(*image, Task())) {
        h.add(d.otsu_threshold()).add(d.mean()).add(d.quantile(0.1));
        for (const Distribution::Atom& a : d.atoms()) h.add(double(a.value)).add(int64_t(a.count));
      }
    });
    return h.digest();
  };
  const Digest one = describe(1);
  for (int round = 0; round < 8; round++) REQUIRE(describe(4) == one);
}

TEST_CASE("what is not finite counts for nothing") {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
  const ImagePtr image = make_image({4, 2}, 1, [&](int x, int y, int) {
    return y == 0 ? float(x) : x == 0 ? nan : x == 1 ? infinite : x == 2 ? -infinite : 3.0f;
  });
  const Distribution d = Distribution::of(*image, Task()).front();
  CHECK(d.quantile(0) == 0);
  CHECK(d.quantile(1) == 3);
  CHECK(d.mean() == doctest::Approx(9.0 / 5));
  const ImagePtr nothing = make_image({4, 2}, 1, [&](int, int, int) { return nan; });
  CHECK(Distribution::of(*nothing, Task()).front().mean() == 0);
}
