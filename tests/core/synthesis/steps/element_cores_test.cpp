#include "core/synthesis/steps/element_cores.h"

#include <doctest/doctest.h>

#include "core/metrics/hybrids.h"
#include "core/synthesis/synthesize.h"
#include "tests/core/synthesis/fields.h"
#include "tests/drawn_tiles.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr int side = 40, block = 2, blocks = 3 * side / block;

/// Three by three tiles as they lie in the exemplar, of which the middle one lacks a corner; that shows another tile in
/// phase, from two tiles farther on.
Field torn() {
  Field field{{blocks, blocks}, std::vector<ExemplarPixel>(size_t(blocks) * blocks)};
  for (int y = 0; y < blocks; y++)
    for (int x = 0; x < blocks; x++) {
      const bool corner = x >= 20 && x < 28 && y >= 20 && y < 30;
      field.at(x, y) = {uint16_t((x * block + (corner ? 2 * side : 0)) % (4 * side)), uint16_t(y * block)};
    }
  return field;
}

struct Completed {
  explicit Completed(FixedPixels fixed = {}) {
    const AppearancePtr appearance = tiles.index(true)->appearance();
    const PaddedLevel padded(appearance->levels().front(), true);
    CorrectionLevel level = level_of(padded, field.size, false, std::move(fixed));
    level.block = block;
    complete_elements(field, level, *appearance);
  }
  DrawnTiles tiles{side};
  Field field = torn();
};

bool is_own(const Field& field, int x, int y) {
  return field.at(x, y) == ExemplarPixel{uint16_t(x * block), uint16_t(y * block)};
}

}  // namespace

TEST_CASE("a tile that lacks a corner gets it, but for its joint") {
  const Completed done;
  for (int y = 20; y < 40; y++)
    for (int x = 20; x < 40; x++) {
      CAPTURE(x);
      CAPTURE(y);
      const bool rim = x == 20 || y == 20;
      const bool corner = x < 28 && y < 30;
      CHECK(is_own(done.field, x, y) == (!corner || !rim));
    }
}

TEST_CASE("kept pixels of a torn tile stay") {
  ExistingPixels kept;
  kept.pixels = torn().pixels;
  kept.keep.assign(kept.pixels.size(), Keep::never);
  kept.keep[size_t(25) * blocks + 25] = Keep::always;
  const Completed done(FixedPixels(kept, {blocks, blocks}, 0, {4 * side, 4 * side}));
  CHECK_FALSE(is_own(done.field, 25, 25));
  CHECK(is_own(done.field, 26, 25));
}

TEST_CASE("small tiles of a lattice are hardly ever put together from several") {
  const DrawnTiles tiles(side);
  const IndexPtr plain = tiles.index(false), known = tiles.index(true);
  const SynthesisOptions options{.size = {400, 390}, .seed = 2};
  const auto hybrids = [&](const Index& index, const SynthesisOptions& o) {
    return hybrid_elements(*synthesize(index, o, Task()), tiles.elements, Task()).by_area;
  };
  CHECK(hybrids(*plain, options) > 0.15);
  CHECK(hybrids(*known, options) < 0.05);
  SynthesisOptions draft = options, loose = options;
  draft.quality = Quality::draft;
  loose.whole_bricks = false;
  for (const SynthesisOptions& o : {draft, loose})
    CHECK(synthesize(*plain, o, Task())->pixels() == synthesize(*known, o, Task())->pixels());
}
