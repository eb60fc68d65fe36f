#include "core/synthesis/steps/element_holes.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <random>

#include <doctest/doctest.h>

using namespace terrazzo;

namespace {

int apart(int a, int b, int length, bool closed) {
  const int d = std::abs(a - b);
  return closed ? std::min(d, length - d) : d;
}

/// By comparing every pixel with every filled one.
std::map<std::pair<int, int>, int64_t> holes_one_by_one(const std::vector<uint8_t>& filled, Size size, bool closed_x,
                                                        bool closed_y, double least, int farthest) {
  std::vector<std::pair<int, int>> all;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++)
      if (filled[size_t(y) * size_t(size.width) + size_t(x)]) all.emplace_back(x, y);
  std::map<std::pair<int, int>, int64_t> out;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      int64_t nearest = int64_t{farthest} * farthest;
      for (const auto& [u, v] : all) {
        const int64_t dx = apart(x, u, size.width, closed_x), dy = apart(y, v, size.height, closed_y);
        nearest = std::min(nearest, dx * dx + dy * dy);
      }
      if (double(nearest) > least * least) out[{x, y}] = nearest;
    }
  return out;
}

}  // namespace

TEST_CASE("holes are where nothing is within the least distance, around closed borders too") {
  const Size size{301, 270};
  std::mt19937 random(7);
  std::vector<uint8_t> filled(size_t(size.area()), 0);
  for (int i = 0; i < 400; i++) filled[random() % filled.size()] = 1;
  for (const bool closed_x : {false, true})
    for (const bool closed_y : {false, true}) {
      const auto holes = find_holes(filled, {size, closed_x, closed_y}, 9.5, 24);
      std::map<std::pair<int, int>, int64_t> found;
      for (const Hole& h : holes) found[{h.column, h.row}] = h.squared;
      CHECK(found == holes_one_by_one(filled, size, closed_x, closed_y, 9.5, 24));
      CHECK(found.size() == holes.size());
      CHECK(std::ranges::is_sorted(holes, std::ranges::greater{}, &Hole::squared));
    }
}

TEST_CASE("a surface without gaps has no holes, an empty one has one in its middle") {
  const Size size{40, 30};
  CHECK(find_holes(std::vector<uint8_t>(size_t(size.area()), 1), {size, true, true}, 1, 10).empty());
  const auto holes = find_holes(std::vector<uint8_t>(size_t(size.area()), 0), {size, true, true}, 1, 10);
  REQUIRE(holes.size() == 1);
  CHECK(holes[0].column == 20);
  CHECK(holes[0].row == 15);
}
