#include "core/picture/contact_sheet.h"

#include <algorithm>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

ImagePtr plain(Size size, float red, float rest, int channels = 3) {
  return make_image(size, channels, [=](int, int, int c) { return c == 0 ? red : rest; });
}

std::vector<float> pixel(const ImagePtr& sheet, int x, int y) {
  return sheet->read({x, y, 1, 1});
}

}  // namespace

TEST_CASE("pictures stand in rows and columns at their own size") {
  const ImagePtr sheet =
      contact_sheet({{plain({20, 10}, 1, 0), plain({30, 40}, 0, 1)}, {nullptr, plain({5, 5}, 0.5f, 0, 1)}}, 200);
  CHECK(sheet->size() == Size{6 + 20 + 6 + 30 + 6, 6 + 40 + 6 + 5 + 6});
  CHECK(pixel(sheet, 6, 6) == std::vector<float>{1, 0, 0});
  CHECK(pixel(sheet, 25, 15) == std::vector<float>{1, 0, 0});
  CHECK(pixel(sheet, 26, 15) == pixel(sheet, 0, 0));
  CHECK(pixel(sheet, 61, 45) == std::vector<float>{0, 1, 1});
  CHECK(pixel(sheet, 32, 52) == std::vector<float>{0.5f, 0.5f, 0.5f});
  CHECK(pixel(sheet, 10, 54) == pixel(sheet, 0, 0));
}

TEST_CASE("large pictures are scaled down together") {
  const ImagePtr sheet = contact_sheet({{plain({400, 400}, 0.25f, 0.75f), plain({800, 800}, 2, -1, 4)}}, 300);
  CHECK(sheet->width() <= 300);
  CHECK(sheet->width() > 290);
  CHECK(sheet->height() < 210);
  CHECK(pixel(sheet, 50, 50)[0] == doctest::Approx(0.25));
  CHECK(pixel(sheet, 50, 50)[2] == doctest::Approx(0.75));
  CHECK(pixel(sheet, 250, 150) == std::vector<float>{1, 0, 0});
}

TEST_CASE("a sheet without pictures, or without room for them, is an error") {
  CHECK_THROWS_AS(contact_sheet({}, 100), Error);
  CHECK_THROWS_AS(contact_sheet({{nullptr}}, 100), Error);
  CHECK_THROWS_AS(contact_sheet({{plain({4, 4}, 0, 0), plain({4, 4}, 0, 0)}}, 19), Error);
}

TEST_CASE("one map stands beside its exemplar, several below") {
  const Map color{"base_color", plain({16, 16}, 0, 0)}, height{"height", plain({16, 16}, 0, 0)};
  const MaterialPtr m = Material::make("m", {color, height});
  CHECK(comparison_sheet(*m, *m, {"height"}, 100)->size() == Size{50, 28 + 9});
  CHECK(comparison_sheet(*m, *m, {"height", "base_color"}, 100)->size() == Size{50, 50 + 2 * 9});
}

TEST_CASE("captions stand below the pictures, at their full height") {
  const std::vector<std::vector<ImagePtr>> rows = {{plain({60, 20}, 0, 0), plain({60, 20}, 0, 0)}};
  const ImagePtr bare = contact_sheet(rows, 400), named = contact_sheet(rows, 400, {{"one", ""}});
  CHECK(named->size() == Size{bare->width(), bare->height() + 9});
  const auto brightest = [&](const Rect& r) {
    const std::vector<float> values = named->read(r);
    return *std::max_element(values.begin(), values.end());
  };
  CHECK(brightest({6, 6 + 20, 60, 9}) > 0.8f);
  CHECK(brightest({72, 6 + 20, 60, 9}) < 0.2f);
}
