#include "core/numeric/distance_transform.h"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "core/base/hash.h"

using namespace terrazzo;

namespace {

std::vector<int64_t> by_hand(const std::vector<uint8_t>& mask, Size size, bool wraps) {
  std::vector<int64_t> out(mask.size(), int64_t{size.width + size.height} * (size.width + size.height));
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++)
      for (int v = 0; v < size.height; v++)
        for (int u = 0; u < size.width; u++) {
          if (!mask[v * size.width + u]) continue;
          int dx = std::abs(u - x), dy = std::abs(v - y);
          if (wraps) {
            dx = std::min(dx, size.width - dx);
            dy = std::min(dy, size.height - dy);
          }
          int64_t& best = out[y * size.width + x];
          best = std::min<int64_t>(best, dx * dx + dy * dy);
        }
  return out;
}

}  // namespace

TEST_CASE("squared distances and nearest set pixels are exact, with and without wrapping, for any shape and density") {
  for (const Size size : {Size{1, 1}, Size{7, 1}, Size{1, 6}, Size{13, 9}, Size{16, 24}})
    for (const int one_in : {2, 9, 60})
      for (const bool wraps : {false, true}) {
        std::vector<uint8_t> mask(size.area());
        for (size_t i = 0; i < mask.size(); i++) mask[i] = below(uint32_t(random_bits(one_in, i)), one_in) == 0;
        CAPTURE(size.width);
        CAPTURE(size.height);
        CAPTURE(one_in);
        CAPTURE(wraps);
        const std::vector<int64_t> expected = by_hand(mask, size, wraps);
        CHECK(squared_distances(mask, size, wraps) == expected);
        if (std::count(mask.begin(), mask.end(), 0) == size.area()) continue;
        const std::vector<uint32_t> nearest = nearest_set(mask, size, wraps);
        for (int i = 0; i < size.area(); i++) {
          std::vector<uint8_t> alone(mask.size());
          alone[nearest[i]] = 1;
          REQUIRE(mask[nearest[i]]);
          REQUIRE(by_hand(alone, size, wraps)[i] == expected[i]);
        }
      }
}

TEST_CASE("signed distances are negative inside, grow by one per pixel and keep to their limit") {
  const Size size{32, 5};
  std::vector<uint8_t> mask(size.area());
  for (int i = 0; i < size.area(); i++) mask[i] = i % 32 < 10;
  const std::vector<float> d = signed_distances(mask, size, false, 6);
  CHECK(d[9] == doctest::Approx(-0.5));
  CHECK(d[10] == doctest::Approx(0.5));
  CHECK(d[12] == doctest::Approx(2.5));
  CHECK(d[31] == 6);
  CHECK(d[0] == -6);
}
