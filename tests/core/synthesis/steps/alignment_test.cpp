#include "core/synthesis/steps/alignment.h"

#include <set>

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include "core/base/hash.h"
#include "core/synthesis/state/pieces.h"
#include "tests/core/synthesis/fields.h"

using namespace terrazzo;

namespace {

constexpr Size side{40, 32};

PaddedLevel noise(bool wraps) {
  AppearanceLevel level;
  level.size = side;
  for (int i = 0; i < int(side.area()); i++) {
    AppearanceVector v{};
    for (int d = 0; d < appearance_dimensions; d++) v[d] = int16_t(below(uint32_t(random_bits(7, i, d)), 2000)) - 1000;
    level.vectors.push_back(v);
  }
  return {level, wraps};
}

/// The exemplar from (9, 7) on, 20x16 pixels; from column 12 on moved by (dx, dy).
Field shifted(int dx, int dy) {
  Field field{{20, 16}, {}};
  for (int y = 0; y < 16; y++)
    for (int x = 0; x < 20; x++)
      field.pixels.push_back({uint16_t(9 + x + (x < 12 ? 0 : dx)), uint16_t(7 + y + (x < 12 ? 0 : dy))});
  return field;
}

}  // namespace

TEST_CASE("pieces that were moved apart find together again") {
  for (const bool wraps : {false, true}) {
    const PaddedLevel exemplar = noise(wraps);
    Field field = shifted(-2, 1);
    REQUIRE(Pieces(field).count() == 2);
    align_pieces(field, 1, test::level_of(exemplar), 2, Task());
    CHECK(Pieces(field).count() == 1);
  }
}

TEST_CASE("pieces whose pixels stand for blocks meet as well, the blocks' pixels one by one") {
  for (const bool wraps : {false, true}) {
    const PaddedLevel exemplar = noise(wraps);
    const auto blocks = [](int dx, int dy) {
      Field field{{10, 8}, {}};
      for (int y = 0; y < 8; y++)
        for (int x = 0; x < 10; x++)
          field.pixels.push_back({uint16_t(9 + 2 * x + (x < 6 ? 0 : dx)), uint16_t(7 + 2 * y + (x < 6 ? 0 : dy))});
      return field;
    };
    Field field = blocks(1, -2);
    REQUIRE(Pieces(field, 2).count() == 2);
    align_pieces(field, 2, test::level_of(exemplar), 2, Task());
    CHECK(Pieces(field, 2).count() == 1);
  }
}

TEST_CASE("the order in which pieces move does not depend on the number of threads") {
  const PaddedLevel exemplar = noise(true);
  std::set<std::vector<uint32_t>> results;
  for (const int threads : {1, 4})
    tbb::task_arena(threads).execute([&] {
      // Squares of 5 pixels, each moved its own way.
      Field field{{60, 60}, {}};
      for (int y = 0; y < 60; y++)
        for (int x = 0; x < 60; x++) {
          const uint64_t bits = random_bits(11, x / 5, y / 5);
          field.pixels.push_back({uint16_t((x + below(uint32_t(bits), 3)) % side.width),
                                  uint16_t((y + below(uint32_t(bits >> 32), 3)) % side.height)});
        }
      const int before = Pieces(field).count();
      align_pieces(field, 1, test::level_of(exemplar), 2, Task());
      CHECK(Pieces(field).count() < before);
      std::vector<uint32_t> result;
      for (const ExemplarPixel p : field.pixels) result.push_back(uint32_t(p.y) << 16 | p.x);
      results.insert(result);
    });
  CHECK(results.size() == 1);
}

TEST_CASE("beyond their reach pieces stay apart, and what fits stays where it is") {
  const PaddedLevel exemplar = noise(false);
  Field apart = shifted(0, 5);
  align_pieces(apart, 1, test::level_of(exemplar), 2, Task());
  CHECK(Pieces(apart).count() == 2);
  Field whole = shifted(0, 0);
  const Field before = whole;
  align_pieces(whole, 1, test::level_of(exemplar), 2, Task());
  CHECK(whole.pixels == before.pixels);
}

TEST_CASE("a piece with fixed pixels stays; its neighbour comes to it") {
  const PaddedLevel exemplar = noise(false);
  Field field = shifted(1, 2);
  ExistingPixels kept{field.pixels, std::vector<Keep>(field.pixels.size())};
  kept.keep[0] = Keep::always;
  const Field wanted = shifted(0, 0);
  align_pieces(field, 1, test::level_of(exemplar, FixedPixels(kept, field.size, 0, side)), 2, Task());
  CHECK(field.pixels == wanted.pixels);
}

TEST_CASE("no piece leaves an exemplar that does not tile") {
  const PaddedLevel exemplar = noise(false);
  // The right part would have to go one column further than windows may.
  Field field{{16, 8}, {}};
  for (int y = 0; y < 8; y++)
    for (int x = 0; x < 16; x++) field.pixels.push_back({uint16_t(24 + x - (x < 8 ? 0 : 1)), uint16_t(9 + y)});
  ExistingPixels kept{field.pixels, std::vector<Keep>(field.pixels.size())};
  kept.keep[0] = Keep::always;
  align_pieces(field, 1, test::level_of(exemplar, FixedPixels(kept, field.size, 0, side)), 2, Task());
  CHECK(Pieces(field).count() == 2);
  for (const ExemplarPixel p : field.pixels) CHECK(p.x < side.width - exemplar.keep_off());
}
