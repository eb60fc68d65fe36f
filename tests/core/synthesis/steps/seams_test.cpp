#include "core/synthesis/steps/seams.h"

#include <algorithm>

#include <doctest/doctest.h>

#include "core/base/hash.h"
#include "core/synthesis/state/pieces.h"
#include "core/synthesis/synthesize.h"
#include "tests/core/synthesis/fields.h"
#include "tests/core/synthesis/noise.h"
#include "tests/exemplars.h"
#include "tests/run_node.h"

using namespace terrazzo;
using test::noise;

namespace {

constexpr Size side{64, 32};
constexpr int agree = 20;  // the exemplar's columns 16 to 20 come again 12 columns further on

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

int columns_of_first_piece(const Field& field, int row) {
  int x = 0;
  while (x < field.size.width && field.at(x, row).x == 4 + x) x++;
  return x;
}

}  // namespace

TEST_CASE("a seam moves to where its two pieces agree, from either side") {
  const PaddedLevel exemplar = exemplar_with_repeat();
  for (const int seam : {9, 20}) {
    CAPTURE(seam);
    Field field = meeting_at(seam);
    move_seams(field, test::level_of(exemplar, field.size), {.reach = 8}, Task());
    for (int y = 0; y < field.size.height; y++) {
      // Output column x shows exemplar column 4 + x; the pieces agree over columns 16 to 20.
      CHECK(columns_of_first_piece(field, y) >= 16 - 4);
      CHECK(columns_of_first_piece(field, y) <= agree - 4 + 1);
    }
  }
}

TEST_CASE("a seam stays where nothing better is in reach, and fixed pixels stay anyway") {
  const PaddedLevel exemplar = exemplar_with_repeat();
  Field best = meeting_at(14);
  const Field before = best;
  move_seams(best, test::level_of(exemplar, best.size), {.reach = 8}, Task());
  CHECK(best.pixels == before.pixels);

  Field field = meeting_at(9);
  ExistingPixels kept{field.pixels, std::vector<Keep>(field.pixels.size())};
  for (int y = 0; y < field.size.height; y++) kept.keep[size_t(y) * field.size.width + 9] = Keep::always;
  const Field fixed = field;
  move_seams(field, test::level_of(exemplar, field.size, false, FixedPixels(kept, field.size, 0, side)), {.reach = 8},
             Task());
  for (int y = 0; y < field.size.height; y++) CHECK(field.at(9, y) == fixed.at(9, y));
}

TEST_CASE("a seam does not go where controls want something else") {
  const PaddedLevel exemplar = exemplar_with_repeat();
  const auto halves = [](Size size, int middle) {
    return test::make_image(size, 1, [=](int x, int, int) { return x < middle ? 0.f : 1.f; });
  };
  for (const int seam : {9, 20}) {
    CAPTURE(seam);
    Field field = meeting_at(seam);
    const Field before = field;
    // Either piece shows one label, wherever it goes on, and the result wants them to meet where they do.
    const std::vector<Control> controls = {
        {.exemplar = halves(side, 24), .target = halves(field.size, seam), .mode = Control::Mode::labels}};
    const ControlPyramid pyramid(controls, side, side, field.size, 1, Task());
    const LevelControl control(pyramid, 0, exemplar);
    CorrectionLevel level = test::level_of(exemplar, field.size);
    level.control = &control;
    move_seams(field, level, {.reach = 8}, Task());
    for (int y = 0; y < field.size.height; y++)
      for (int x = 0; x < field.size.width; x++)
        CHECK(control.cost(field.at(x, y).x, field.at(x, y).y, control.target_near(x, y)) <=
              control.cost(before.at(x, y).x, before.at(x, y).y, control.target_near(x, y)));
    CHECK(columns_of_first_piece(field, 8) == seam);
  }
}

namespace {

constexpr int tile = 12;

/// Tiles, each of a shade of its own, with joints of two pixels; neighbourhoods are not blurred into one another.
PaddedLevel tiled_exemplar() {
  AppearanceLevel level;
  level.size = {10 * tile, 6 * tile};
  for (int y = 0; y < level.size.height; y++)
    for (int x = 0; x < level.size.width; x++) {
      AppearanceVector v{};
      for (int d = 0; d < 3; d++) {
        const uint64_t shade = random_bits(9, x / tile, y / tile, d), grain = random_bits(10, x, y, d);
        v[d] = int16_t(x % tile < 2 || y % tile < 2 ? -1200 : int(below(uint32_t(shade), 1000)));
        v[d] += int16_t(below(uint32_t(grain), 60));
      }
      level.vectors.push_back(v);
    }
  return {level, false};
}

constexpr Size blocks{4 * tile / 2, 3 * tile / 2};  // of two by two pixels

/// Two pieces, the right one five tiles further on, that meet in the middle of tiles.
Field meeting_in_tiles() {
  Field field{blocks, {}};
  for (int y = 0; y < blocks.height; y++)
    for (int x = 0; x < blocks.width; x++)
      field.pixels.push_back({uint16_t(tile + 2 * x + (x < 15 ? 0 : 5 * tile)), uint16_t(tile + 2 * y)});
  return field;
}

/// The blocks, joints left out, that show another tile than most of their tile do.
int blocks_of_other_tiles(const Field& field) {
  int others = 0;
  for (int column = 0; column < 4; column++)
    for (int row = 0; row < 3; row++) {
      int far = 0, all = 0;
      for (int y = row * tile / 2 + 1; y < (row + 1) * tile / 2; y++)
        for (int x = column * tile / 2 + 1; x < (column + 1) * tile / 2; x++, all++)
          far += field.at(x, y).x - tile - 2 * x == 5 * tile;
      others += std::min(far, all - far);
    }
  return others;
}

CorrectionLevel in_blocks(const PaddedLevel& exemplar, Size size = blocks) {
  CorrectionLevel level = test::level_of(exemplar, size);
  level.block = 2;
  return level;
}

}  // namespace

TEST_CASE("seams leave the middles of tiles for their joints") {
  const PaddedLevel exemplar = tiled_exemplar();
  Field field = meeting_in_tiles();
  REQUIRE(blocks_of_other_tiles(field) > 20);
  move_seams(field, in_blocks(exemplar), {.reach = 8}, Task());
  CHECK(blocks_of_other_tiles(field) == 0);
  // Both pieces are still there, and each goes on as in the exemplar.
  CHECK(Pieces(field, in_blocks(exemplar)).count() == 2);
}

TEST_CASE("to be far from its piece costs a pixel: seams go to a joint all the same, but stay if that costs too much") {
  const PaddedLevel exemplar = tiled_exemplar();
  Field field = meeting_in_tiles();
  const Field before = field;
  move_seams(field, in_blocks(exemplar), {.reach = 8, .distance_penalty = 8}, Task());
  CHECK(blocks_of_other_tiles(field) == 0);

  field = before;
  move_seams(field, in_blocks(exemplar), {.reach = 8, .distance_penalty = 4000}, Task());
  CHECK(field.pixels == before.pixels);
}

TEST_CASE("a large piece swallows a small one, unless to be large or far from it costs that") {
  AppearanceLevel level;
  level.size = {96, 64};
  for (int i = 0; i < level.size.area(); i++) level.vectors.push_back({int16_t(below(uint32_t(random_bits(8, i)), 4))});
  const PaddedLevel plain(level, false);
  const auto left_of_small = [&](double fair, double distance_penalty) {
    Field field{{30, 20}, {}};
    for (int y = 0; y < 20; y++)
      for (int x = 0; x < 30; x++) {
        const bool small = x >= 12 && x < 18 && y >= 7 && y < 13;
        field.pixels.push_back({uint16_t(4 + 2 * x + (small ? 25 : 0)), uint16_t(4 + 2 * y)});
      }
    move_seams(field, in_blocks(plain, field.size),
               {.reach = 8, .distance_penalty = distance_penalty, .target_area = fair}, Task());
    int left = 0;
    for (int y = 0; y < 20; y++)
      for (int x = 0; x < 30; x++) left += field.at(x, y).x != 4 + 2 * x;
    return left;
  };
  CHECK(left_of_small(0, 0) == 0);
  CHECK(left_of_small(50, 0) >= 36);
  CHECK(left_of_small(0, 8) == 36);
}

TEST_CASE("all of an exemplar that tiles in cells is shown about as often, what lies at its border, too") {
  // Cells of 64 pixels that are alike but for some grain.
  const ImagePtr image = test::make_image({128, 128}, 1, [](int x, int y, int) {
    return float(unit_double(random_bits(1, x % 64 / 2, y % 64 / 2)) + 0.8 * unit_double(random_bits(2, x / 2, y / 2)));
  });
  const FeaturesPtr features = test::plain_features(image, true)->with(Lattice{2, {64, 0}, {0, 64}, 1});
  const IndexPtr index = make_index(make_appearance(*features, {}, {}, Task()), 3, Task());
  const Size size{640, 640};
  const UvMapPtr uv = synthesize(*index, {.size = size, .seed = 1}, Task());
  int middle = 0;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const ExemplarPixel p = uv->at(x, y);
      middle += p.x >= 32 && p.x < 96 && p.y >= 32 && p.y < 96;
    }
  const double share = double(middle) / double(size.area());
  CHECK(share == doctest::Approx(0.25).epsilon(0.2));
}
