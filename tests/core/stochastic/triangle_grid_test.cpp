#include "core/stochastic/triangle_grid.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <doctest/doctest.h>

using namespace terrazzo;

namespace {

using Vertices = std::array<GridVertex, 3>;

/// Which vertices count for a pixel, seen from where and how much.
std::map<std::array<int64_t, 3>, double> counting(const Vertices& vertices) {
  std::map<std::array<int64_t, 3>, double> out;
  for (const GridVertex& v : vertices)
    if (v.weight > 0) out[{int64_t(v.bits), v.dx, v.dy}] = v.weight;
  return out;
}

}  // namespace

TEST_CASE("the squares of weights sum to 1, and samples reach no farther than they say") {
  for (const int cell : {1, 2, 7, 64})
    for (const Size size : {Size{1, 1}, Size{3, 200}, Size{130, 97}}) {
      const TriangleGrid grid(cell, {size, cell != 7, cell != 2}, 5);
      for (int y = -40; y < 90; y++)
        for (int x = -60; x < 140; x++) {
          double squares = 0;
          for (const GridVertex& v : grid.around(x, y)) {
            squares += v.weight * v.weight;
            REQUIRE(v.weight >= 0);
            REQUIRE(std::abs(v.dx) <= grid.reach_x());
            REQUIRE(std::abs(v.dy) <= grid.reach_y());
          }
          REQUIRE(squares == doctest::Approx(1));
        }
    }
}

TEST_CASE("a vertex is seen from around it at the distance that it has") {
  const TriangleGrid grid(20, {}, 3);
  std::map<uint64_t, std::set<std::array<int64_t, 2>>> places;
  for (int y = 0; y < 100; y++)
    for (int x = 0; x < 100; x++)
      for (const GridVertex& v : grid.around(x, y))
        if (v.weight > 0) places[v.bits].insert({x - v.dx, y - v.dy});
  CHECK(places.size() > 30);
  for (const auto& [bits, at] : places) CHECK(at.size() == 1);
}

TEST_CASE("weights change little from pixel to pixel: no triangle's edge is seen") {
  const TriangleGrid grid(50, {{150, 172}, true, true}, 3);
  for (int y = 0; y < 200; y++)
    for (int x = 0; x < 200; x++)
      for (const auto& [dx, dy] : {std::array{1, 0}, std::array{0, 1}}) {
        std::map<uint64_t, double> here, there;
        for (const GridVertex& v : grid.around(x, y)) here[v.bits] += v.weight;
        for (const GridVertex& v : grid.around(x + dx, y + dy)) there[v.bits] += v.weight;
        for (const auto& [bits, weight] : here) REQUIRE(std::abs(weight - there[bits]) < 0.25);
        for (const auto& [bits, weight] : there) REQUIRE(std::abs(weight - here[bits]) < 0.25);
      }
}

TEST_CASE("a surface wraps in the directions asked for, after any number of pixels, and in no other") {
  for (const Size size : {Size{1, 1}, Size{101, 64}, Size{64, 333}, Size{7, 1}}) {
    const TriangleGrid both(24, {size, true, true}, 9), x_only(24, {size, true, false}, 9);
    bool differs = false;
    for (int y = 0; y < 80; y++)
      for (int x = 0; x < 80; x++) {
        const auto here = counting(both.around(x, y));
        REQUIRE(here == counting(both.around(x + size.width, y)));
        REQUIRE(here == counting(both.around(x - int64_t{3} * size.width, y + int64_t{5} * size.height)));
        const auto free = counting(x_only.around(x, y));
        REQUIRE(free == counting(x_only.around(x - size.width, y)));
        differs = differs || free != counting(x_only.around(x, y + size.height));
      }
    CHECK(differs);
  }
}

TEST_CASE("places far away are like those near by, and other seeds give other vertices") {
  const TriangleGrid grid(16, {}, 1), other(16, {}, 2);
  std::set<uint64_t> seen;
  for (const int64_t far : {int64_t{0}, int64_t{-1000000000}, int64_t{1000000000}, int64_t{1} << 39})
    for (int i = 0; i < 100; i++) {
      const Vertices v = grid.around(far + 8 * i, far - 8 * i);
      double squares = 0;
      for (const GridVertex& g : v) squares += g.weight * g.weight;
      REQUIRE(squares == doctest::Approx(1));
      seen.insert(v[0].bits);
    }
  CHECK(seen.size() > 150);
  CHECK(grid.around(100, 100)[0].bits != other.around(100, 100)[0].bits);
}
