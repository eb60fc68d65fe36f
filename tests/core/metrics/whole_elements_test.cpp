#include "core/metrics/whole_elements.h"

#include <functional>

#include <doctest/doctest.h>

#include "core/base/hash.h"

using namespace terrazzo;

namespace {

constexpr int cell = 24, cells = 5;
constexpr Size exemplar_size{cell * cells, cell* cells};

/// A grid of tiles of 24x24 pixels, each a region of its own.
Elements tiles() {
  Elements out{exemplar_size, {}, cells * cells, 1};
  for (int y = 0; y < exemplar_size.height; y++)
    for (int x = 0; x < exemplar_size.width; x++) out.at.push_back(uint16_t(y / cell * cells + x / cell));
  return out;
}

/// Every cell of the result shows the tile that `tile` names, moved by `moved` pixels to the right. The exemplar tiles.
UvMapPtr laid(Size size, const std::function<int(int, int)>& tile, const std::function<int(int, int)>& moved,
              UvWraps wraps = {}) {
  std::vector<ExemplarPixel> pixels;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const int name = tile(x / cell, y / cell);
      const int u = name % cells * cell + x % cell + moved(x / cell, y / cell), v = name / cells * cell + y % cell;
      pixels.push_back({uint16_t(u % exemplar_size.width), uint16_t(v)});
    }
  return UvMap::make(size, exemplar_size, std::move(pixels), {wraps.x, wraps.y, true});
}

int any_tile(int x, int y) {
  return int(random_bits(1, x, y) % uint64_t(cells * cells));
}
int none(int, int) {
  return 0;
}

}  // namespace

TEST_CASE("tiles that are laid as wholes are whole, and different ones are counted") {
  const UvMapPtr uv = laid({10 * cell, 8 * cell}, any_tile, none);
  const ShownElements shown = shown_elements(*uv, tiles(), {});
  // The insides of tiles do not reach the border of the result.
  CHECK(shown.whole == 80);
  CHECK(shown.all == 80);
  CHECK(shown.distinct > 20);
  CHECK(shown.missing < 0.2);
  CHECK_FALSE(shown.are_broken(false));
  CHECK_FALSE(shown.lack_most());
  // Cut in halves at the right.
  CHECK(shown_elements(*laid({9 * cell + cell / 2, 8 * cell}, any_tile, none), tiles(), {}).all <= 80);
}

TEST_CASE("halves of two tiles that meet without a joint are no whole tile") {
  // Half a tile to the right: the joint lies in the middle of each cell, and none at its edge.
  const UvMapPtr uv = laid({10 * cell, 10 * cell}, any_tile, [](int, int) { return cell / 2; });
  const ShownElements shown = shown_elements(*uv, tiles(), {});
  CHECK(shown.whole < 10);
  CHECK(shown.are_broken(false));
  // In a few places only, they are not enough to doubt the rest.
  const UvMapPtr few =
      laid({10 * cell, 10 * cell}, any_tile, [](int x, int y) { return x % 5 == 2 && y % 5 == 2 ? cell / 2 : 0; });
  const ShownElements most = shown_elements(*few, tiles(), {});
  CHECK(most.whole >= 80);
  CHECK(most.whole < 100);
  CHECK_FALSE(most.are_broken(false));
}

TEST_CASE("a field without joints is no whole element, however much it shows of one") {
  std::vector<ExemplarPixel> pixels(size_t(240) * 240, ExemplarPixel{cell / 2, cell / 2});
  const UvMapPtr uv = UvMap::make({240, 240}, exemplar_size, std::move(pixels));
  const ShownElements shown = shown_elements(*uv, tiles(), {});
  CHECK(shown.whole == 0);
  CHECK(shown.all > 50);
  CHECK(shown.are_broken(false));
}

TEST_CASE("what of the exemplar is not shown is missing") {
  const UvMapPtr uv = laid(
      {10 * cell, 10 * cell}, [](int x, int y) { return any_tile(x, y) % 5; }, none);
  const ShownElements shown = shown_elements(*uv, tiles(), {});
  CHECK(shown.missing == doctest::Approx(0.8));
  CHECK(shown.distinct == 5);
  CHECK(shown.lack_most());
  CHECK_FALSE(shown.are_broken(false));
}

TEST_CASE("elements go on across the border of a result that wraps") {
  const auto tile = [](int, int) { return 12; };
  const Size odd{10 * cell - cell / 2, 4 * cell};
  const ShownElements open = shown_elements(*laid(odd, tile, none), tiles(), {});
  const ShownElements closed = shown_elements(*laid(odd, tile, none, {.x = true}), tiles(), {});
  CHECK(open.whole == 36);
  CHECK(closed.whole == 36);
  CHECK(closed.all > open.all - 5);
}

TEST_CASE("tiny exemplars and results are no trouble") {
  const Elements one{{1, 1}, {0}, 1, 1};
  const UvMapPtr uv = UvMap::make({3, 2}, {1, 1}, std::vector<ExemplarPixel>(6));
  const ShownElements shown = shown_elements(*uv, one, {});
  CHECK(shown.whole <= shown.all);
}

TEST_CASE("torn elements are marked, whole and cut ones are not") {
  // Halves of two tiles in one cell; the other cells are whole.
  const int torn_x = 3, torn_y = 2;
  std::vector<ExemplarPixel> pixels;
  const Size size{6 * cell + cell / 2, 5 * cell};
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const bool other = x / cell == torn_x && y / cell == torn_y && x % cell >= cell / 2;
      const int column = other ? 4 : 1;
      pixels.push_back({uint16_t(column * cell + x % cell), uint16_t(3 * cell + y % cell)});
    }
  const UvMapPtr uv = UvMap::make(size, exemplar_size, std::move(pixels), {false, false, true});
  const std::vector<uint8_t> torn = torn_elements(*uv, tiles(), {});
  REQUIRE(torn.size() == size_t(size.area()));
  int marked = 0;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      if (!torn[size_t(y * size.width + x)]) continue;
      marked++;
      CHECK(x / cell == torn_x);
      CHECK(y / cell == torn_y);
    }
  // All of its inside: joints take the rest.
  CHECK(marked > cell * cell / 3);
  CHECK(torn[size_t((torn_y * cell + cell / 2) * size.width + torn_x * cell + cell / 2)] == 1);
}

TEST_CASE("how many elements a result has is told by the size of those that the exemplar's border does not cut") {
  // The grid starts half a tile off: 16 whole tiles within a rim of 20 cut ones.
  constexpr int across = cells + 1;
  Elements some{exemplar_size, {}, across * across, 1};
  for (int y = 0; y < exemplar_size.height; y++)
    for (int x = 0; x < exemplar_size.width; x++)
      some.at.push_back(uint16_t((y + cell / 2) / cell * across + (x + cell / 2) / cell));
  CHECK(whole_elements(some, false) == 16);
  CHECK(whole_elements(some, true) == 36);
  const Size size{8 * cell, 6 * cell};
  std::vector<ExemplarPixel> pixels;
  const auto in_whole = [](int at) { return uint16_t(cell / 2 + at % (4 * cell)); };
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) pixels.push_back({in_whole(x), in_whole(y)});
  const ShownElements shown = shown_elements(*UvMap::make(size, exemplar_size, std::move(pixels), {}), some, {});
  CHECK(shown.whole == 48);
  CHECK(shown.all == 48);
}

TEST_CASE("stones of a heap lie under others, but not most of them") {
  const ShownElements half{.whole = 50, .all = 100}, few{.whole = 40, .all = 100};
  CHECK(half.are_broken(false));
  CHECK_FALSE(half.are_broken(true));
  CHECK(few.are_broken(true));
}
