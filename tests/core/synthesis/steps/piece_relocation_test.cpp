#include "core/synthesis/steps/piece_relocation.h"

#include <set>

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include "core/base/hash.h"
#include "core/synthesis/state/pieces.h"
#include "core/synthesis/state/usage_penalty.h"
#include "tests/core/synthesis/noise.h"

using namespace terrazzo;
using test::noise;

namespace {

constexpr Size side{64, 48};
constexpr int again = 32;  // columns: the exemplar's right half is the left one again, but for every eighth pixel

PaddedLevel exemplar_seen_twice() {
  AppearanceLevel level;
  level.size = side;
  for (int y = 0; y < side.height; y++)
    for (int x = 0; x < side.width; x++)
      level.vectors.push_back(noise(x >= again && (x + y) % 8 != 0 ? x - again : x, y));
  level.usable.assign(level.vectors.size(), 1);
  return {level, false};
}

constexpr int hole = 8, hole_side = 8;
bool in_hole(int x, int y) {
  return std::min(x, y) >= hole && std::max(x, y) < hole + hole_side;
}

/// The left half of the exemplar from (4, 4) on, 24x24 pixels, with something else in the 8x8 pixels in its middle.
Field field_with(ExemplarPixel middle) {
  Field field{{24, 24}, {}};
  for (int y = 0; y < 24; y++)
    for (int x = 0; x < 24; x++) {
      field.pixels.push_back(in_hole(x, y) ? ExemplarPixel{uint16_t(middle.x + x - hole), uint16_t(middle.y + y - hole)}
                                           : ExemplarPixel{uint16_t(4 + x), uint16_t(4 + y)});
    }
  return field;
}

/// Every pixel is similar to the one half the exemplar away.
std::vector<ExemplarPixel> other_halves() {
  std::vector<ExemplarPixel> out;
  for (int y = 0; y < side.height; y++)
    for (int x = 0; x < side.width; x++) out.push_back({uint16_t((x + again) % side.width), uint16_t(y)});
  return out;
}

CorrectionLevel level_of(const PaddedLevel& exemplar, const std::vector<ExemplarPixel>& similar,
                         FixedPixels fixed = {}) {
  return {
      .exemplar = exemplar, .similar = similar, .per_pixel = 1, .window = {}, .phase = {}, .fixed = std::move(fixed)};
}

/// Made when it is asked for: tuning constants are not there before main.
const UsagePenalty& all_alike() {
  static const UsagePenalty usage(side, 0, 1);
  return usage;
}

/// Nothing but what is in the hole may change.
void refill_hole(Field& field, const UsagePenalty& usage) {
  const PaddedLevel exemplar = exemplar_seen_twice();
  const std::vector<ExemplarPixel> similar = other_halves();
  ExistingPixels kept{field.pixels, std::vector<Keep>(field.pixels.size(), Keep::always)};
  for (int y = 0; y < 24; y++)
    for (int x = 0; x < 24; x++) kept.keep[size_t(y) * 24 + x] = in_hole(x, y) ? Keep::never : Keep::always;
  relocate_pieces(field, 1, level_of(exemplar, similar, {kept, field.size, 0, side}), usage, 1, Task());
}

}  // namespace

TEST_CASE("a piece that does not fit shows what the exemplar has that fits there, and keeps its shape") {
  Field field = field_with({50, 36});
  const Field before = field;
  refill_hole(field, all_alike());
  // What goes on in the left half would fit better still, but would make one piece of the two.
  CHECK(field.at(hole, hole) == ExemplarPixel{4 + hole + again, 4 + hole});
  CHECK(Pieces(field).count() == 2);
  for (int y = 0; y < 24; y++)
    for (int x = 0; x < 24; x++)
      CHECK(field.at(x, y) ==
            (in_hole(x, y) ? ExemplarPixel{uint16_t(4 + again + x), uint16_t(4 + y)} : before.at(x, y)));
}

TEST_CASE("a piece is not refilled with what shows near it already") {
  Field field = field_with({50, 36});
  // The place that would fit shows to the right of the hole, so that something else, or nothing, is to be taken.
  for (int y = hole; y < hole + hole_side; y++)
    for (int x = 16; x < 24; x++) field.at(x, y) = {uint16_t(4 + again + x - hole), uint16_t(4 + y)};
  refill_hole(field, all_alike());
  CHECK(field.at(hole, hole) != ExemplarPixel{4 + hole + again, 4 + hole});
}

TEST_CASE("a piece that fits is left as it is") {
  Field field = field_with({4 + hole + again, 4 + hole});
  const Field before = field;
  refill_hole(field, all_alike());
  CHECK(field.pixels == before.pixels);
}

TEST_CASE("a piece is not refilled with what is in use too much") {
  Field field = field_with({50, 36});
  // Everything shows the place that would fit.
  UsagePenalty crowded(side, 1000, 1);
  Field use{{64, 64}, std::vector<ExemplarPixel>(64 * 64)};
  for (int i = 0; i < 64 * 64; i++)
    use.pixels[size_t(i)] = {uint16_t(4 + hole + again + i % 8), uint16_t(4 + hole + i / 8 % 8)};
  crowded.recount(use, {});
  refill_hole(field, crowded);
  CHECK(field.at(hole, hole) != ExemplarPixel{4 + hole + again, 4 + hole});
}

TEST_CASE("what is refilled does not depend on the number of threads, and pieces cut by a border stay whole") {
  const PaddedLevel exemplar = exemplar_seen_twice();
  const std::vector<ExemplarPixel> similar = other_halves();
  const auto squares = [](int cut) {
    Field field{{60, 60}, std::vector<ExemplarPixel>(3600)};
    for (int y = 0; y < 60; y++)
      for (int x = 0; x < 60; x++) {
        const uint64_t bits = random_bits(3, x / 6, y / 6);
        field.at((x + cut) % 60, y) = {uint16_t(below(uint32_t(bits), 58) + x % 6),
                                       uint16_t(below(uint32_t(bits >> 32), 42) + y % 6)};
      }
    return field;
  };
  std::set<std::vector<uint32_t>> results;
  int refilled = 0;
  for (const int threads : {1, 4})
    tbb::task_arena(threads).execute([&] {
      Field field = squares(3);
      const Field before = field;
      CorrectionLevel level = level_of(exemplar, similar);
      level.window.closed_x = level.window.closed_y = true;
      relocate_pieces(field, 1, level, all_alike(), 1, Task());
      std::vector<uint32_t> shown;
      for (size_t i = 0; i < field.pixels.size(); i++) {
        shown.push_back(uint32_t(field.pixels[i].y) << 16 | field.pixels[i].x);
        refilled += !(field.pixels[i] == before.pixels[i]);
      }
      results.insert(shown);
      // Squares that are cut by the border are still whole.
      CHECK(Pieces(field, 1, true, true).count() == Pieces(before, 1, true, true).count());
    });
  CHECK(results.size() == 1);
  CHECK(refilled > 0);
}
