#include "core/synthesis/state/jitter.h"

#include <doctest/doctest.h>

#include "core/synthesis/synthesize.h"
#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;
using Shape = JitterSpec::Shape;

namespace {

AppearancePtr three_levels() {
  return wall_index({64, 64})->appearance();
}

}  // namespace

TEST_CASE("a list gives each level its own jitter, a single number all the same") {
  const AppearancePtr appearance = three_levels();
  REQUIRE(appearance->levels().size() == 3);
  CHECK(jitter_amplitudes({Shape::list, {3, 1}}, *appearance) == std::vector<double>{3, 1, 0});
  CHECK(jitter_amplitudes({Shape::list, {3, 2, 1, 9}}, *appearance) == std::vector<double>{3, 2, 1});
  for (const Shape shape : {Shape::automatic, Shape::list, Shape::constant})
    CHECK(jitter_amplitudes({shape, {2}}, *appearance) == std::vector<double>{2, 2, 2});
  CHECK(jitter_amplitudes({Shape::list, {}}, *appearance) == std::vector<double>{0, 0, 0});
}

TEST_CASE("a distribution has its peak where it should and falls off to one side or both") {
  const AppearancePtr appearance = three_levels();
  const auto peak = jitter_amplitudes({Shape::peak, {4}, 1, 1}, *appearance);
  CHECK(peak[1] == 4);
  CHECK(peak[0] == doctest::Approx(4 * 0.60653));
  CHECK(peak[2] == peak[0]);
  CHECK(jitter_amplitudes({Shape::rising, {4}, 1, 1}, *appearance) == std::vector<double>{peak[0], 4, 0});
  CHECK(jitter_amplitudes({Shape::falling, {4}, 1, 1}, *appearance) == std::vector<double>{0, 4, peak[2]});
  CHECK(jitter_amplitudes({Shape::peak, {4}, 1, 0.5}, *appearance)[0] < peak[0]);
}

TEST_CASE("jitter at any level changes the result, however large and whether or not the exemplar tiles") {
  for (const bool wraps : {false, true}) {
    const IndexPtr index = wall_index({64, 64}, wraps);
    const Digest still = synthesize(*index, {.size = {100, 90}}, Task())->digest();
    for (size_t level = 0; level < 3; level++) {
      std::vector<double> jitter(3, 0.0);
      jitter[level] = 1000;
      CHECK(synthesize(*index, {.size = {100, 90}, .jitter = jitter}, Task())->digest() != still);
    }
  }
}
