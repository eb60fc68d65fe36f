#include "runner/editor/previews/uv_piece.h"

#include <array>
#include <functional>
#include <vector>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/exemplar/uv_image.h"

using namespace terrazzo;

namespace {

/// A result in which `shift_at` says how far each pixel's source is away, modulo the exemplar.
ImagePtr fractions(Size size, Size exemplar, const std::function<std::array<int, 2>(int x, int y)>& shift_at) {
  std::vector<ExemplarPixel> pixels;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const auto [dx, dy] = shift_at(x, y);
      pixels.push_back({uint16_t(wrap(x + dx, exemplar.width)), uint16_t(wrap(y + dy, exemplar.height))});
    }
  return uv_as_fractions(UvMap::make(size, exemplar, std::move(pixels)));
}

}  // namespace

TEST_CASE("a piece is what is connected and has the same shift") {
  constexpr Size exemplar{37, 23};
  // Two squares that touch at a corner, with the same shift, on a ground with another.
  const ImagePtr uv = fractions({20, 12}, exemplar, [](int x, int y) {
    const bool upper = x >= 2 && x < 6 && y >= 1 && y < 4, lower = x >= 6 && x < 9 && y >= 4 && y < 7;
    return upper || lower ? std::array{30, 5} : std::array{3, 20};
  });
  const UvPiece upper = uv_piece_at(*uv, exemplar, 4, 2);
  CHECK(upper.shift == std::array{30, 5});
  CHECK(upper.runs == std::vector<UvPiece::Run>{{1, 2, 6}, {2, 2, 6}, {3, 2, 6}});
  CHECK(upper.area == 12);
  CHECK(upper.is_whole);
  const UvPiece lower = uv_piece_at(*uv, exemplar, 6, 4);
  CHECK(lower.area == 9);
  const UvPiece ground = uv_piece_at(*uv, exemplar, 0, 0);
  CHECK(ground.shift == std::array{3, 20});
  CHECK(ground.area == 20 * 12 - 12 - 9);
  CHECK(ground.is_whole);
}

TEST_CASE("a piece is followed through large maps, up to a limit") {
  constexpr Size exemplar{512, 512};
  const auto one = [](int, int) { return std::array{100, 200}; };
  const UvPiece all = uv_piece_at(*fractions({700, 40}, exemplar, one), exemplar, 5, 5);
  CHECK(all.area == 700 * 40);
  CHECK(all.is_whole);
  const UvPiece part = uv_piece_at(*fractions({5000, 8}, exemplar, one), exemplar, 2500, 4);
  CHECK(part.area == 2048 * 8);
  CHECK(!part.is_whole);
  CHECK_THROWS_AS(
      uv_piece_at(*Image::from_floats({.size = {4, 4}, .channels = 1}, std::vector<float>(16)), exemplar, 0, 0), Error);
}
