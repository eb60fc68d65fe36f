#include "core/synthesis/state/fixed_pixels.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include "core/synthesis/steps/correction.h"
#include "core/synthesis/synthesize.h"
#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

ExistingPixels identity(Size size, bool (*keep)(int, int)) {
  ExistingPixels kept;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      kept.pixels.push_back({uint16_t(x), uint16_t(y)});
      kept.keep.push_back(keep(x, y) ? Keep::always : Keep::never);
    }
  return kept;
}

bool outside_hole(int x, int y) {
  return x < 16 || x >= 36 || y < 12 || y >= 30;
}

}  // namespace

TEST_CASE("a pixel of a level is fixed if all pixels below it are kept, at the place in the middle of theirs") {
  const ExistingPixels kept = identity({13, 10}, [](int x, int y) { return x != 5 || y != 3; });
  const FixedPixels fixed(kept, {13, 10}, 2, {4, 3});
  Field field{{4, 3}, std::vector<ExemplarPixel>(12, {99, 99})};
  fixed.apply(field, PlaneWindow::all_of({field.size}));
  for (int y = 0; y < 3; y++)
    for (int x = 0; x < 4; x++) {
      const bool free = x == 1 && y == 0;
      CHECK(fixed.at(size_t(y) * 4 + x) == !free);
      CHECK(field.at(x, y) == (free ? ExemplarPixel{99, 99} : ExemplarPixel{uint16_t(x), uint16_t(y)}));
    }
}

TEST_CASE("what is kept at first begins as it is, and is not fixed") {
  ExistingPixels kept = identity({16, 4}, [](int x, int) { return x < 4; });
  for (int y = 0; y < 4; y++)
    for (int x = 4; x < 11; x++) kept.keep[size_t(y) * 16 + x] = Keep::at_first;
  const FixedPixels fixed(kept, {16, 4}, 2, {4, 1});
  Field field{{4, 1}, std::vector<ExemplarPixel>(4, {99, 99})};
  fixed.begin(field, PlaneWindow::all_of({field.size}));
  CHECK(field.pixels == std::vector<ExemplarPixel>{{0, 0}, {1, 0}, {2, 0}, {99, 99}});
  for (size_t x = 0; x < 4; x++) CHECK(fixed.at(x) == (x == 0));
}

TEST_CASE("a lattice may bend around the border, between the pixels that always stay") {
  ExistingPixels kept = identity({20, 12}, [](int x, int y) { return x >= 3 && x < 15 && y >= 2 && y < 12; });
  kept.keep[0] = Keep::at_first;
  const LatticeGaps gaps = kept.gaps({20, 12});
  CHECK(gaps.x.begin == 15);
  CHECK(gaps.x.length == 8);
  CHECK(gaps.y.begin == 12);
  CHECK(gaps.y.length == 2);
  CHECK(ExistingPixels{}.gaps({20, 12}).x.length == 0);
}

TEST_CASE("nothing kept, nothing fixed") {
  const FixedPixels fixed({}, {8, 8}, 0, {8, 8});
  CHECK(!fixed.any());
  CHECK(!fixed.at(63));
}

TEST_CASE("kept pixels stay bit for bit and the others are made, the same on any number of threads") {
  const IndexPtr index = wall_index();
  SynthesisOptions options{.size = {48, 40}, .tile_x = true, .tile_y = true, .jitter = {2, 2, 2, 2}};
  options.kept = identity(options.size, outside_hole);
  std::set<Digest> digests;
  for (const int threads : {1, 3})
    tbb::task_arena(threads).execute([&] {
      const UvMapPtr uv = synthesize(*index, options, Task());
      digests.insert(uv->digest());
      int moved = 0;
      for (int y = 0; y < 40; y++)
        for (int x = 0; x < 48; x++) {
          const bool same = uv->at(x, y) == ExemplarPixel{uint16_t(x), uint16_t(y)};
          if (outside_hole(x, y)) REQUIRE(same);
          moved += !same;
        }
      CHECK(moved > 0);
    });
  CHECK(digests.size() == 1);
}

TEST_CASE("where all is kept nothing changes") {
  const IndexPtr index = wall_index();
  SynthesisOptions options{.size = {48, 40}};
  options.kept = identity(options.size, [](int, int) { return true; });
  CHECK(synthesize(*index, options, Task())->pixels() == options.kept.pixels);
}

TEST_CASE("where no whole number of courses fits, the new ones follow those that are kept and bend until they wrap") {
  const FeaturesPtr plain = plain_features(wall({64, 64}));
  const IndexPtr index =
      make_index(make_appearance(*plain->with(Lattice{1, {0, 16}, {}, 1}), {}, {}, Task()), 3, Task());
  SynthesisOptions options{.size = {64, 67}, .tile_x = true, .tile_y = true};
  options.kept = identity(options.size, [](int, int y) { return y < 28; });
  for (ExemplarPixel& p : options.kept.pixels) p.y = std::min<uint16_t>(p.y, 63);
  const UvMapPtr uv = synthesize(*index, options, Task());
  int in_phase = 0, all = 0;
  for (int y = 28; y < 67; y++)
    for (int x = 0; x < 64; x++, all++) {
      const double off = uv->at(x, y).y - (y - 3 * (y - 28) / 39.0);
      in_phase += std::abs(off - 16 * std::round(off / 16)) <= 1.2;
    }
  CHECK(in_phase > 0.9 * all);
}

TEST_CASE("evenness counts free pixels only") {
  Field field{{32, 32}, std::vector<ExemplarPixel>(32 * 32, {0, 0})};
  const ExistingPixels kept = identity(field.size, [](int x, int) { return x < 16; });
  UsagePenalty all({32, 32}, 1, 0.5), free({32, 32}, 1, 0.5);
  for (int y = 0; y < 32; y++)
    for (int x = 16; x < 32; x++) field.at(x, y) = {uint16_t(x * 2 - 32), uint16_t(y)};
  all.recount(field, {});
  free.recount(field, FixedPixels(kept, field.size, 0, {32, 32}));
  CHECK(all.factor(0, 0) > unit_factor);
  CHECK(free.factor(0, 0) == unit_factor);
}
