#include "core/synthesis/seams.h"

#include <doctest/doctest.h>

#include "core/hash.h"
#include "core/synthesis/pieces.h"

using namespace terrazzo;

namespace {

constexpr Size side{64, 32};
constexpr int agree = 20;  // the exemplar's columns 16 to 20 come again 12 columns further on

AppearanceVector noise(int x, int y) {
  AppearanceVector v{};
  for (int d = 0; d < appearance_dimensions; d++) v[d] = int16_t(below(uint32_t(random_bits(7, x, y, d)), 2000)) - 1000;
  return v;
}

PaddedLevel exemplar_with_repeat() {
  AppearanceLevel level;
  level.size = side;
  for (int y = 0; y < side.height; y++)
    for (int x = 0; x < side.width; x++) level.vectors.push_back(noise(x >= 28 && x <= 12 + agree ? x - 12 : x, y));
  return {level, false};
}

/// Two pieces, the right one 12 columns further on, which meet at `seam`.
Field meeting_at(int seam) {
  Field field{{36, 16}, {}};
  for (int y = 0; y < 16; y++)
    for (int x = 0; x < 36; x++) field.pixels.push_back({uint16_t(4 + x + (x < seam ? 0 : 12)), uint16_t(7 + y)});
  return field;
}

CorrectionLevel level_of(const PaddedLevel& exemplar, const std::vector<ExemplarPixel>& none, FixedPixels fixed = {}) {
  return {.exemplar = exemplar, .similar = none, .window = {}, .phase = {}, .fixed = std::move(fixed)};
}

int columns_of_first_piece(const Field& field, int row) {
  int x = 0;
  while (x < field.size.width && field.at(x, row).x == 4 + x) x++;
  return x;
}

}  // namespace

TEST_CASE("a seam moves to where its two pieces agree, from either side") {
  const std::vector<ExemplarPixel> none;
  const PaddedLevel exemplar = exemplar_with_repeat();
  for (const int seam : {9, 20}) {
    CAPTURE(seam);
    Field field = meeting_at(seam);
    move_seams(field, level_of(exemplar, none), 8, Task());
    for (int y = 0; y < field.size.height; y++) {
      // Output column x shows exemplar column 4 + x; the pieces agree over columns 16 to 20.
      CHECK(columns_of_first_piece(field, y) >= 16 - 4);
      CHECK(columns_of_first_piece(field, y) <= agree - 4 + 1);
    }
  }
}

TEST_CASE("a seam stays where nothing better is in reach, and fixed pixels stay anyway") {
  const std::vector<ExemplarPixel> none;
  const PaddedLevel exemplar = exemplar_with_repeat();
  Field best = meeting_at(14);
  const Field before = best;
  move_seams(best, level_of(exemplar, none), 8, Task());
  CHECK(best.pixels == before.pixels);

  Field field = meeting_at(9);
  KeptPixels kept{field.pixels, std::vector<uint8_t>(field.pixels.size(), 0)};
  for (int y = 0; y < field.size.height; y++) kept.keep[size_t(y) * field.size.width + 9] = 1;
  const Field fixed = field;
  move_seams(field, level_of(exemplar, none, FixedPixels(kept, field.size, 0, side)), 8, Task());
  for (int y = 0; y < field.size.height; y++) CHECK(field.at(9, y) == fixed.at(9, y));
}
