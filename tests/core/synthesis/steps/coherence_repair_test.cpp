#include "core/synthesis/steps/coherence_repair.h"

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include "core/synthesis/state/usage_penalty.h"
#include "core/synthesis/state/window_coherence.h"
#include "tests/core/synthesis/fields.h"
#include "tests/core/synthesis/slopes.h"

using namespace terrazzo;

namespace {

constexpr Size exemplar_size{64, 64};
constexpr Size field_size{44, 40};
constexpr Size large{150, 130};  // several windows at a time
constexpr Rect wrong{18, 16, 5, 4};

void rework(Field& field, const CorrectionLevel& level) {
  UsagePenalty evenness(exemplar_size, 0, 1);
  repair_incoherent(field, level, evenness, 4, 1, Task());
}

int64_t incoherence(const Field& field, const CorrectionLevel& level) {
  const WindowCoherence window_coherence(level);
  int64_t sum = 0;
  for (int y = 0; y + WindowCoherence::side <= field.size.height; y++)
    for (int x = 0; x + WindowCoherence::side <= field.size.width; x++) {
      WindowCoherence::Window shown;
      for (int i = 0; i < WindowCoherence::side * WindowCoherence::side; i++)
        shown[i] = field.at(x + i % WindowCoherence::side, y + i / WindowCoherence::side);
      sum += window_coherence.incoherence(shown);
    }
  return sum;
}

}  // namespace

TEST_CASE("a place unlike the exemplar is covered by what goes on around it") {
  const PaddedLevel exemplar = test::slopes(exemplar_size);
  Field field = test::with_wrong_place(field_size, wrong, {12, 47});
  rework(field, test::level_of(exemplar, field_size));
  CHECK(field.pixels == test::one_piece(field_size).pixels);
}

TEST_CASE("what is like the exemplar stays, whether it shows seams or not") {
  const PaddedLevel exemplar = test::slopes(exemplar_size);
  const CorrectionLevel level = test::level_of(exemplar, field_size);
  Field whole = test::one_piece(field_size);
  rework(whole, level);
  CHECK(whole.pixels == test::one_piece(field_size).pixels);
  Field nearly = test::one_piece(field_size);
  for (int y = wrong.y; y < wrong.bottom(); y++)
    for (int x = wrong.x; x < wrong.right(); x++) nearly.at(x, y).x++;
  const Field before = nearly;
  REQUIRE(incoherence(before, level) == 0);
  rework(nearly, level);
  CHECK(nearly.pixels == before.pixels);
}

TEST_CASE("reworking leaves fixed pixels alone") {
  const PaddedLevel exemplar = test::slopes(exemplar_size);
  Field field = test::with_wrong_place(field_size, wrong, {12, 47});
  ExistingPixels kept{field.pixels, std::vector<Keep>(field.pixels.size())};
  for (int y = wrong.y; y < wrong.bottom(); y++)
    for (int x = wrong.x; x < wrong.right(); x++) kept.keep[size_t(y) * field_size.width + x] = Keep::always;
  rework(field, test::level_of(exemplar, field_size, false, FixedPixels(kept, field_size, 0, exemplar_size)));
  for (int y = wrong.y; y < wrong.bottom(); y++)
    for (int x = wrong.x; x < wrong.right(); x++)
      CHECK(field.at(x, y) == test::with_wrong_place(field_size, wrong, {12, 47}).at(x, y));
}

TEST_CASE("reworking shows nothing that a mask forbids") {
  std::vector<uint8_t> usable(size_t(exemplar_size.area()), 1);
  // Where the piece goes on below the wrong place.
  const int u = 9 + wrong.x + 2, v = 11 + wrong.y + 1;
  usable[size_t(v) * exemplar_size.width + u] = 0;
  const PaddedLevel exemplar = test::slopes(exemplar_size, usable);
  Field field = test::with_wrong_place(field_size, wrong, {12, 47});
  rework(field, test::level_of(exemplar, field_size));
  CHECK(field.pixels != test::with_wrong_place(field_size, wrong, {12, 47}).pixels);
  bool shown = false;
  for (const ExemplarPixel& p : field.pixels) shown |= p.x == u && p.y == v;
  CHECK_FALSE(shown);
}

TEST_CASE("less is unlike the exemplar than before, and the same on one thread as on many") {
  const PaddedLevel exemplar = test::slopes(exemplar_size);
  for (const bool closed : {false, true})
    for (const int side : {5, 7}) {
      CAPTURE(closed);
      CAPTURE(side);
      const CorrectionLevel level = test::level_of(exemplar, large, closed);
      const Field before = test::rubble(side, large);
      Field many = before, one = before;
      tbb::task_arena(4).execute([&] { rework(many, level); });
      tbb::task_arena(1).execute([&] { rework(one, level); });
      CHECK(many.pixels == one.pixels);
      CHECK(incoherence(many, level) < incoherence(before, level));
    }
}
