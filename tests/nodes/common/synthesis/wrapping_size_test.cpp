#include "nodes/common/synthesis/wrapping_size.h"

#include <cmath>
#include <utility>

#include <doctest/doctest.h>

namespace terrazzo {

TEST_CASE("the size that fits best, fits, and is near what was asked for") {
  // Those of a woven fabric scanned a little askew, bricks, courses, columns, and tiles turned by some degrees.
  const Lattice fabric{2, {8.30, 12.24}, {-8.23, 12.27}, 0.77};
  for (const Lattice& lattice : {fabric, Lattice{2, {40.3, 0}, {20.15, 17.8}, 0.5}, Lattice{1, {0, 23.7}, {}, 0.5},
                                 Lattice{1, {31.4, 0}, {}, 0.5}, Lattice{2, {19.8, 1.4}, {-1.4, 19.8}, 0.9},
                                 Lattice{2, {19.8, 0.06}, {-0.06, 19.8}, 0.9}})
    for (const Size size : {Size{1024, 1024}, Size{512, 700}, Size{4096, 333}})
      for (const auto& [x, y] : {std::pair(true, true), std::pair(true, false), std::pair(false, true)}) {
        CAPTURE(lattice.first.x());
        CAPTURE(size.width);
        const Size best = best_wrapping_size(lattice, size, x, y, {100, 100});
        for (const bool along_x : {true, false}) {
          if (!(along_x ? x : y)) continue;
          const Vector2d v = lattice.misfit(along_x ? best.width : best.height, along_x);
          CHECK(std::abs(along_x ? v.x() : v.y()) < 1.5);
          CHECK(std::hypot(v.x(), v.y()) < 10);
        }
        CHECK(2 * best.width > size.width);
        CHECK(2 * best.height > size.height);
        CHECK(8 * best.width <= 9 * size.width);
        CHECK(8 * best.height <= 9 * size.height);
        if (!x) CHECK(best.width == size.width);
        if (!y) CHECK(best.height == size.height);
        // The lattice that such a result has is hardly another.
        const Lattice whole = lattice.fitted(best, x, y);
        CHECK(std::abs(whole.first.x() - lattice.first.x()) + std::abs(whole.first.y() - lattice.first.y()) < 0.5);
      }
  CHECK_FALSE(fabric.fits({1024, 1024}, true, true));
  CHECK(fabric.fits({1024, 1024}, false, false));
}

TEST_CASE("of two sizes near by the one is taken that bends cells less") {
  const Lattice grid{2, {40, 0}, {0, 60}, 0.5};
  // Five cells and a little, five and nearly a sixth.
  CHECK(best_wrapping_size(grid, {205, 355}, true, true, {50, 50}) == Size{200, 360});
  CHECK(best_wrapping_size(grid, {205, 355}, true, false, {50, 50}) == Size{200, 355});
  // Nothing to bend in: only what fits will do. All the surface to bend in: a pixel in hundreds does not matter.
  CHECK(best_wrapping_size(grid, {401, 600}, true, true, {4, 4}) == Size{400, 600});
  CHECK(best_wrapping_size(grid, {401, 600}, true, true, {4000, 4000}) == Size{401, 600});
  CHECK(best_wrapping_size(Lattice{}, {250, 250}, true, true, {9, 9}) == Size{250, 250});
}

}  // namespace terrazzo
