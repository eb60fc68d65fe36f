#include "runner/report/pictures.h"

#include <doctest/doctest.h>

#include "runner/report/charts.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("a picture is shrunk, and each of its pixels is the mean of those it stands for") {
  const ImagePtr image = make_image({64, 32}, 1, [](int x, int, int) { return x % 2 ? 1.0f : 0.0f; });
  const PagePicture picture = page_picture(image, 32);
  CHECK(picture.size == Size{64, 32});
  CHECK(picture.shrunk->size() == Size{32, 16});
  for (const float v : picture.shrunk->pixels()) CHECK(v == 0.5f);
  CHECK(picture.histogram[32] == 1.0f);
  CHECK(picture.uri.starts_with("data:image/png;base64,iVBOR"));
}

TEST_CASE("heights beyond 0 to 1 are stretched to it; other values are clipped") {
  const auto steps = [](int x, int, int) { return float(x) - 1; };
  ImageInfo info{.size = {4, 1}, .channels = 1, .semantic = Semantic::height};
  std::vector<float> values;
  for (int x = 0; x < 4; x++) values.push_back(steps(x, 0, 0));
  CHECK(page_picture(Image::from_floats(info, values), 8).shrunk->pixels() ==
        std::vector<float>{0, 1.0f / 3, 2.0f / 3, 1});
  info.semantic = Semantic::data;
  CHECK(page_picture(Image::from_floats(info, values), 8).shrunk->pixels() == std::vector<float>{0, 0, 1, 1});
}

TEST_CASE("a uv map in colours says where in the exemplar pixels are from") {
  const UvMapPtr uv = UvMap::make({2, 1}, {4, 2}, {{0, 0}, {3, 1}});
  const std::vector<float> pixels = uv_in_colours(*uv, 16)->pixels();
  CHECK(pixels[0] == doctest::Approx(0.125));
  CHECK(pixels[1] == doctest::Approx(0.25));
  CHECK(pixels[3] == doctest::Approx(0.875));
  CHECK(pixels[4] == doctest::Approx(0.75));
}

TEST_CASE("times are bars on an axis, and names in them are escaped") {
  RunResult result;
  result.stages.resize(2);
  result.stages[0].node = "a<b";
  result.stages[1].node = "idle";
  result.spans = {{"run", 0, 0, 0.5, 2.0}, {"store", 0, 0, 2.0, 4.0}};
  const std::string html = times_html(result);
  CHECK(contains(html, "a&lt;b"));
  CHECK_FALSE(contains(html, "idle"));
  CHECK(contains(html, "class=\"run\" title=\"run, 1.500 s\" style=\"left:12.500%;width:37.500%\""));
  CHECK(times_html({}) == "");
}
