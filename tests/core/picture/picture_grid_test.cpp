#include "core/picture/picture_grid.h"

#include <cmath>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

ImagePtr plain(Size size, std::vector<float> color, const std::string& space = "raw") {
  return make_image(
      size, int(color.size()), [=](int, int, int c) { return color[size_t(c)]; }, Semantic::data, space);
}

std::vector<float> pixel(const ImagePtr& sheet, int x, int y) {
  return sheet->read({x, y, 1, 1});
}

GridSpec cells(int columns, Size cell, int gap) {
  GridSpec spec;
  spec.columns = columns;
  spec.cell = cell;
  spec.gap = gap;
  return spec;
}

}  // namespace

TEST_CASE("pictures stand row by row in cells of one size, centred at their own size") {
  const std::vector<ImagePtr> pictures = {plain({20, 20}, {1, 0, 0}), plain({10, 6}, {0, 1, 0}),
                                          plain({20, 20}, {0, 0, 1})};
  const ImagePtr sheet = picture_grid(pictures, cells(2, {20, 20}, 4), {});
  REQUIRE(sheet->size() == Size{4 + 20 + 4 + 20 + 4, 4 + 20 + 4 + 20 + 4});
  const std::vector<float> background = pixel(sheet, 0, 0);
  CHECK(pixel(sheet, 4, 4) == std::vector<float>{1, 0, 0});
  CHECK(pixel(sheet, 23, 23) == std::vector<float>{1, 0, 0});
  CHECK(pixel(sheet, 24, 23) == background);
  CHECK(pixel(sheet, 28 + 5, 4 + 7) == std::vector<float>{0, 1, 0});
  CHECK(pixel(sheet, 28 + 4, 4 + 7) == background);
  CHECK(pixel(sheet, 28 + 5, 4 + 6) == background);
  CHECK(pixel(sheet, 28 + 14, 4 + 12) == std::vector<float>{0, 1, 0});
  CHECK(pixel(sheet, 4, 28) == std::vector<float>{0, 0, 1});
  CHECK(pixel(sheet, 28, 28) == background);
  CHECK(picture_grid({pictures[0]}, cells(4, {20, 20}, 4), {})->size() == Size{28, 28});
}

TEST_CASE("large pictures are scaled to fit and keep their proportions; small ones grow if asked") {
  const ImagePtr wide = plain({80, 20}, {1, 1, 1}), small = plain({5, 10}, {1, 1, 1});
  const auto white = [](const ImagePtr& sheet) {
    Size extent;
    for (int i = 0; i < 20; i++) {
      extent.width += pixel(sheet, i, 10)[0] == 1;
      extent.height += pixel(sheet, 10, i)[0] == 1;
    }
    return extent;
  };
  GridSpec spec = cells(1, {20, 20}, 0);
  CHECK(white(picture_grid({wide}, spec, {})) == Size{20, 5});
  CHECK(white(picture_grid({small}, spec, {})) == Size{5, 10});
  spec.enlarge = true;
  CHECK(white(picture_grid({small}, spec, {})) == Size{10, 20});
}

TEST_CASE("every kind of image is shown as a picture") {
  const std::vector<ImagePtr> pictures = {plain({4, 4}, {0.25f}), plain({4, 4}, {0.5f, 1}),
                                          plain({4, 4}, {0, 0.5f, 1, 0}), plain({4, 4}, {-3, 7, std::nanf("")}),
                                          plain({4, 4}, {0.5f, 0.5f, 0.5f}, "lin_rec709")};
  const ImagePtr sheet = picture_grid(pictures, cells(5, {4, 4}, 0), {});
  CHECK(sheet->info().color_space == "srgb_texture");
  CHECK(pixel(sheet, 0, 0) == std::vector<float>{0.25f, 0.25f, 0.25f});
  CHECK(pixel(sheet, 4, 0) == std::vector<float>{0.5f, 0.5f, 0.5f});
  CHECK(pixel(sheet, 8, 0) == std::vector<float>{0, 0.5f, 1});
  CHECK(pixel(sheet, 12, 0) == std::vector<float>{0, 1, 0});
  CHECK(pixel(sheet, 16, 0)[1] == doctest::Approx(0.7354).epsilon(0.001));
}

TEST_CASE("captions stand below their pictures, large enough to read, and stay within their cells") {
  const ImagePtr black = plain({40, 10}, {0, 0, 0});
  GridSpec spec = cells(2, {40, 10}, 2);
  const Size bare = picture_grid({black, black}, spec, {})->size();
  spec.captions = {"", "far"};
  REQUIRE(picture_grid({black, black}, spec, {})->height() == bare.height + 18);
  spec.captions = {"", "far too long for this"};
  const ImagePtr sheet = picture_grid({black, black}, spec, {});
  REQUIRE(sheet->size() == Size{bare.width, bare.height + 3 * 18});
  const std::vector<float> background = pixel(sheet, 0, 0);
  int left = 0, right = 0, outside = 0;
  for (int y = 12; y < sheet->height(); y++)
    for (int x = 0; x < sheet->width(); x++) {
      if (pixel(sheet, x, y) == background) continue;
      (x < 42 ? left : right)++;
      outside += x >= 84 || (y - 12) % 18 < 4;
    }
  CHECK(left == 0);
  CHECK(right > 3 * 2 * 4 * 10);
  CHECK(outside == 0);
}

TEST_CASE("a grid without pictures, with captions for none, or beyond all size is an error") {
  const ImagePtr dot = plain({4, 4}, {0});
  CHECK_THROWS_WITH_AS(picture_grid({}, {}, {}), doctest::Contains("at least one picture"), Error);
  GridSpec spec;
  spec.captions = {"a", "b"};
  CHECK_THROWS_WITH_AS(picture_grid({dot}, spec, {}),
                       doctest::Contains("at most 1 caption, one for each picture; found 2"), Error);
  CHECK_THROWS_WITH_AS(picture_grid(std::vector<ImagePtr>(5, dot), cells(5, {8192, 8}, 0), {}),
                       doctest::Contains("make the cells smaller"), Error);
}
