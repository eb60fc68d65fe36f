#include "core/synthesis/steps/graphcut_repair.h"

#include <doctest/doctest.h>
#include <tbb/global_control.h>

#include "core/base/hash.h"
#include "core/synthesis/state/expansion.h"
#include "core/synthesis/state/usage_penalty.h"
#include "tests/core/synthesis/fields.h"
#include "tests/core/synthesis/noise.h"

using namespace terrazzo;

namespace {

constexpr Size exemplar_size{64, 64};
constexpr Size field_size{44, 40};
constexpr Size large{170, 150};  // several windows at a time

PaddedLevel noise(const std::vector<uint8_t>& usable = {}) {
  AppearanceLevel level;
  level.size = exemplar_size;
  level.usable = usable;
  for (int y = 0; y < exemplar_size.height; y++)
    for (int x = 0; x < exemplar_size.width; x++) level.vectors.push_back(test::noise(x, y));
  return {level, false};
}

constexpr Rect wrong{18, 16, 5, 4};

void mend(Field& field, const CorrectionLevel& level) {
  UsagePenalty evenness(exemplar_size, 0, 1);
  repair_seams(field, level, evenness, 1, Task());
}

int64_t mismatch(Field field, const CorrectionLevel& level) {
  const ExpansionProblem problem(field, level);
  int64_t sum = 0;
  for (int i = 0; i < int(field.pixels.size()); i++)
    for (int side = 0; side < 2; side++) {
      const int64_t n = problem.plane.beside(i, side);
      if (n >= 0) sum += problem.mismatch(field.pixels[i], field.pixels[size_t(n)], side);
    }
  return sum;
}

}  // namespace

TEST_CASE("what does not belong there is covered by what goes on around it") {
  const PaddedLevel exemplar = noise();
  Field field = test::with_wrong_place(field_size, wrong, {4, 5});
  mend(field, test::level_of(exemplar, field_size));
  CHECK(field.pixels == test::one_piece(field_size).pixels);
}

TEST_CASE("a result without seams stays as it is") {
  const PaddedLevel exemplar = noise();
  Field field = test::one_piece(field_size);
  mend(field, test::level_of(exemplar, field_size));
  CHECK(field.pixels == test::one_piece(field_size).pixels);
}

TEST_CASE("fixed pixels stay, whatever they show") {
  const PaddedLevel exemplar = noise();
  Field field = test::with_wrong_place(field_size, wrong, {4, 5});
  ExistingPixels kept{field.pixels, std::vector<Keep>(field.pixels.size())};
  for (int y = wrong.y; y < wrong.bottom(); y++)
    for (int x = wrong.x; x < wrong.right(); x++) kept.keep[size_t(y) * field_size.width + x] = Keep::always;
  mend(field, test::level_of(exemplar, field_size, false, FixedPixels(kept, field_size, 0, exemplar_size)));
  CHECK(field.pixels == test::with_wrong_place(field_size, wrong, {4, 5}).pixels);
}

TEST_CASE("what a mask forbids is not shown") {
  std::vector<uint8_t> usable(size_t(exemplar_size.area()), 1);
  // Where the piece goes on below the wrong place.
  const int u = 9 + wrong.x + 2, v = 11 + wrong.y + 1;
  usable[size_t(v) * exemplar_size.width + u] = 0;
  const PaddedLevel exemplar = noise(usable);
  Field field = test::with_wrong_place(field_size, wrong, {4, 5});
  mend(field, test::level_of(exemplar, field_size));
  bool shown = false;
  for (const ExemplarPixel& p : field.pixels) shown |= p.x == u && p.y == v;
  CHECK_FALSE(shown);
}

TEST_CASE("mending lowers the mismatch and gives the same pixels on one thread as on many") {
  const PaddedLevel exemplar = noise();
  for (const bool closed : {false, true})
    for (const int side : {5, 9}) {
      CAPTURE(closed);
      CAPTURE(side);
      const CorrectionLevel level = test::level_of(exemplar, large, closed);
      Field many = test::rubble(side, large), one = test::rubble(side, large);
      mend(many, level);
      {
        const tbb::global_control single(tbb::global_control::max_allowed_parallelism, 1);
        mend(one, level);
      }
      CHECK(many.pixels == one.pixels);
      CHECK(mismatch(many, level) < mismatch(test::rubble(side, large), level));
    }
}
