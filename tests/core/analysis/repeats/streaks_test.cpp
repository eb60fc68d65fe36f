#include "core/analysis/repeats/streaks.h"

#include <doctest/doctest.h>

#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr Size size = {192, 160};

Streaks streaks_of(const Features& features) {
  return with_streaks(features, Task()).streaks;
}

/// Of which no direction differs from another.
ImagePtr speckles(Size s) {
  return make_image(s, 3, [](int x, int y, int) { return float(unit_double(random_bits(9, x, y))); });
}

}  // namespace

TEST_CASE("brushed metal has streaks along its brushing, and what is alike in all directions has none") {
  CHECK(streaks_of(*plain_features(brushed(size, true))) == Streaks{4, 1});
  CHECK(streaks_of(*plain_features(brushed(size, false))) == Streaks{1, 4});
  CHECK(streaks_of(*plain_features(speckles(size))) == Streaks{});
  CHECK(streaks_of(*plain_features(wall(size))) == Streaks{});
}

TEST_CASE("streaks are shortened as far as two levels are left") {
  CHECK(streaks_of(*plain_features(brushed({64, 160}))) == Streaks{2, 1});
  CHECK(streaks_of(*plain_features(brushed({63, 160}))) == Streaks{});
  CHECK(streaks_of(*plain_features(brushed({512, 160}))).x >= 8);
}

TEST_CASE("what is not a streak in a single place keeps all of the exemplar as it is") {
  const ImagePtr metal = brushed(size);
  const ImagePtr with_dots = make_image(size, 3, [&](int x, int y, int c) {
    const bool dots = x >= 100 && x < 148 && y >= 40 && y < 80;
    return dots ? float(unit_double(random_bits(3, x, y))) : metal->in_memory()[(size_t(y) * size.width + x) * 3 + c];
  });
  CHECK(streaks_of(*plain_features(with_dots)) == Streaks{});
}

TEST_CASE("an exemplar that tiles holds whole steps") {
  CHECK(streaks_of(*plain_features(brushed(size), true)) == Streaks{4, 1});
  CHECK(streaks_of(*plain_features(brushed({190, 160}), true)) == Streaks{2, 1});
  CHECK(streaks_of(*plain_features(brushed({191, 160}), true)) == Streaks{});
}

TEST_CASE("masks, elements, cells and courses that are not sure leave streaks alone") {
  const FeaturesPtr metal = plain_features(brushed(size));
  const ImagePtr mask = make_image(size, 1, [](int x, int, int) { return x < 150 ? 1.0f : 0.0f; });
  CHECK(streaks_of(*Features::make(size, metal->images(), false, {}, mask)) == Streaks{});
  Elements one{size, std::vector<uint16_t>(size_t(size.area())), 1, 1};
  CHECK(streaks_of(*metal->with(std::make_shared<const Elements>(one))) == Streaks{});
  CHECK(streaks_of(*metal->with(Lattice{2, {16, 0}, {0, 16}, 1})) == Streaks{});
  CHECK(streaks_of(*metal->with(Lattice{1, {0, 20}, {}, 0.5})) == Streaks{});
}

TEST_CASE("sure courses along streaks stay, columns across them have none") {
  const FeaturesPtr metal = plain_features(brushed({512, 160}));
  const Repeats boards = with_streaks(*metal->with(Lattice{1, {0, 20}, {}, 0.9}), Task());
  CHECK(boards.streaks.x == 8);  // three levels are left
  CHECK(boards.lattice.rank == 1);
  CHECK(streaks_of(*metal->with(Lattice{1, {20, 0}, {}, 0.9})) == Streaks{});
}

TEST_CASE("courses that are seldom, hardly alike or follow one another along the streaks are left out") {
  const Lattice seldom{1, {0, 100}, {}, 0.5};
  const Repeats repeats = with_streaks(*plain_features(brushed(size))->with(seldom), Task());
  CHECK(repeats.streaks.any());
  CHECK(repeats.lattice.rank == 0);
  CHECK(repeats.lattice.certainty == 0.5);
  const Repeats tiles = with_streaks(*plain_features(brushed(size), true)->with(seldom), Task());
  CHECK_FALSE(tiles.streaks.any());
  CHECK(tiles.lattice == seldom);
  const Repeats hardly = with_streaks(*plain_features(brushed(size))->with(Lattice{1, {0, 20}, {}, 0.15}), Task());
  CHECK(hardly.streaks.any());
  CHECK(hardly.lattice.rank == 0);
  const Repeats crossed = with_streaks(*plain_features(brushed(size))->with(Lattice{1, {20, 0}, {}, 0.5}), Task());
  CHECK(crossed.streaks.any());
  CHECK(crossed.lattice.rank == 0);
  const Repeats without = with_streaks(*plain_features(speckles(size))->with(seldom), Task());
  CHECK(without.lattice == seldom);
}
