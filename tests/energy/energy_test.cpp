#include "tests/energy/energy.h"

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include "tests/core/synthesis/fields.h"
#include "tests/core/synthesis/slopes.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr Size size{40, 36};
constexpr int64_t all = int64_t{size.width} * size.height;

Energy energy(const Field& field, int64_t sample = all) {
  static const PaddedLevel exemplar = slopes({64, 64});
  return energy_of(field, level_of(exemplar, field.size), sample, Task());
}

}  // namespace

TEST_CASE("what is copied in one piece costs nothing") {
  const Energy e = energy(one_piece(size));
  CHECK(e.pixels == all);
  CHECK(e.windows == 0);
  CHECK(e.unlike == 0);
  CHECK(e.seams == 0);
  CHECK(e.cut == 0);
  CHECK(e.phase == 0);
}

TEST_CASE("a patch from elsewhere costs its outline, and the windows that cross it") {
  constexpr Rect patch{10, 12, 9, 7};
  const Energy e = energy(with_wrong_place(size, patch, {40, 30}));
  CHECK(e.cut == 2 * (patch.width + patch.height));
  CHECK(e.seams > 0);
  CHECK(e.windows > 0);
  CHECK(e.unlike > 0);
  // Windows of 7x7 reach three pixels beyond the patch.
  CHECK(e.unlike <= (patch.width + 6) * (patch.height + 6));
  CHECK(energy(with_wrong_place(size, patch, {20, 24})).seams < e.seams);  // nearer in the exemplar, and more alike
}

TEST_CASE("smaller blocks cost more, in every term") {
  const Energy small = energy(rubble(4, size)), large = energy(rubble(12, size));
  CHECK(small.cut > large.cut);
  CHECK(small.seams > large.seams);
  CHECK(small.windows > large.windows);
  CHECK(small.unlike > large.unlike);
}

TEST_CASE("a sample of the pixels tells about the same, for any number of threads") {
  const Field field = rubble(8, {160, 160});
  const Energy whole = energy(field, 160 * 160), some = energy(field, 3000);
  CHECK(some.pixels < 4000);
  const auto share = [](int64_t sum, const Energy& e) { return double(sum) / double(e.pixels); };
  CHECK(share(some.windows, some) == doctest::Approx(share(whole.windows, whole)).epsilon(0.1));
  CHECK(share(some.seams, some) == doctest::Approx(share(whole.seams, whole)).epsilon(0.15));
  Energy alone;
  tbb::task_arena(1).execute([&] { alone = energy(field, 3000); });
  CHECK(alone.windows == some.windows);
  CHECK(alone.seams == some.seams);
}
