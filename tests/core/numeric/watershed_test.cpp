#include "core/numeric/watershed.h"

#include <set>

#include <doctest/doctest.h>

#include "core/base/hash.h"

using namespace terrazzo;

namespace {

/// Low cells of 8x8 pixels between lines of the given height.
std::vector<uint8_t> cells(Size size, uint8_t line) {
  std::vector<uint8_t> relief;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) relief.push_back(x % 8 == 0 || y % 8 == 0 ? line : 10);
  return relief;
}

constexpr Size size{32, 24};

}  // namespace

TEST_CASE("each minimum has a basin, which ends on the lines around it") {
  const Regions basins = catchment_basins(cells(size, 200), size, true);
  CHECK(basins.count == 4 * 3);
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++)
      if (x % 8 != 0 && y % 8 != 0)
        CHECK(basins.at[size_t(y * size.width + x)] == basins.at[size_t((y / 8 * 8 + 4) * size.width + x / 8 * 8 + 4)]);
}

TEST_CASE("where the relief wraps, basins go on around its borders") {
  // Lines in the middle only: around the borders there is one basin.
  std::vector<uint8_t> relief(size_t(size.area()), 10);
  for (int y = 0; y < size.height; y++) relief[size_t(y * size.width + 16)] = 90;
  CHECK(catchment_basins(relief, size, false).count == 2);
  CHECK(catchment_basins(relief, size, true).count == 1);
}

TEST_CASE("borders tell how long they are and how high") {
  const std::vector<uint8_t> relief = cells({16, 8}, 200);
  const Regions basins = catchment_basins(relief, {16, 8}, false);
  REQUIRE(basins.count == 2);
  const std::vector<RegionBorder> borders = region_borders(basins, relief, {16, 8}, false);
  REQUIRE(borders.size() == 1);
  CHECK(borders.front().length == 8);
  CHECK(borders.front().mean() == 200);
}

TEST_CASE("regions are joined across borders that are low, and small ones in any case") {
  std::vector<uint8_t> relief = cells(size, 200);
  // A lower line between the first two cells.
  for (int y = 1; y < 8; y++) relief[size_t(y * size.width + 8)] = 60;
  const Regions basins = catchment_basins(relief, size, true);
  const std::vector<RegionBorder> borders = region_borders(basins, relief, size, true);
  CHECK(joined(basins, borders, {.least = 20, .least_of_large = 20}).count == 12);
  CHECK(joined(basins, borders, {.least = 130, .least_of_large = 130}).count == 11);
  // Of large regions less is asked.
  CHECK(joined(basins, borders, {.least = 130, .least_of_large = 30, .large = 40}).count == 12);
  CHECK(joined(basins, borders, {.least = 0, .least_of_large = 0, .large = 0, .smallest = 100}).count <= 6);
  CHECK(joined(basins, borders, {.least = 256, .least_of_large = 256}).count == 1);
}

TEST_CASE("flooding from seeds reaches every pixel and keeps the seeds") {
  const std::vector<uint8_t> relief = cells(size, 200);
  std::vector<uint32_t> seeds(relief.size(), no_region);
  seeds[4 * 32 + 4] = 0;
  seeds[20 * 32 + 28] = 1;
  const Regions regions = flooded(relief, size, false, seeds);
  CHECK(regions.count == 2);
  CHECK(regions.at[4 * 32 + 4] == 0);
  CHECK(regions.at[20 * 32 + 28] == 1);
  for (const uint32_t r : regions.at) CHECK(r < 2);
}

TEST_CASE("noise of any shape is parted into connected regions, the same each time") {
  for (const Size s : {Size{1, 1}, Size{1, 9}, Size{7, 1}, Size{17, 13}})
    for (const bool wraps : {false, true}) {
      std::vector<uint8_t> relief(size_t(s.area()));
      for (size_t i = 0; i < relief.size(); i++) relief[i] = uint8_t(random_bits(3, i));
      const Regions basins = catchment_basins(relief, s, wraps);
      CHECK(basins.count >= 1);
      CHECK(std::set<uint32_t>(basins.at.begin(), basins.at.end()).size() == size_t(basins.count));
      CHECK(basins.at == catchment_basins(relief, s, wraps).at);
    }
}
