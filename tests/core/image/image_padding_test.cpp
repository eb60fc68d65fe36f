#include <doctest/doctest.h>

#include "tests/run_node.h"

using namespace terrazzo;

TEST_CASE("a padded region shows the border pixels going on, or the image again, however far it reaches") {
  const ImagePtr image = test::make_image({5, 3}, 2, [](int x, int y, int c) { return float(100 * c + 10 * y + x); });
  for (const Rect region : {Rect{-2, -1, 4, 3}, Rect{-13, -8, 30, 20}, Rect{3, 1, 9, 1}, Rect{-9, 5, 2, 2},
                            Rect{1, 1, 2, 2}, Rect{7, 4, 3, 3}}) {
    const std::vector<float> clamped = read_padded(*image, region, Outside::clamp);
    const std::vector<float> wrapped = read_padded(*image, region, Outside::wrap);
    for (int y = 0; y < region.height; y++)
      for (int x = 0; x < region.width; x++)
        for (int c = 0; c < 2; c++) {
          const size_t at = (size_t(y) * region.width + x) * 2 + c;
          const int sx = region.x + x, sy = region.y + y;
          CHECK(clamped[at] == float(100 * c + 10 * std::clamp(sy, 0, 2) + std::clamp(sx, 0, 4)));
          CHECK(wrapped[at] == float(100 * c + 10 * wrap(sy, 3) + wrap(sx, 5)));
        }
  }
}
