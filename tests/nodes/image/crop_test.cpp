#include <doctest/doctest.h>

#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

float place(int x, int y, int) {
  return float(x + 100 * y);
}

}  // namespace

TEST_CASE("crop gives exactly the pixels of the rectangle") {
  const ImagePtr image = make_image({20, 10}, 1, place);
  const ImagePtr part =
      run_image("crop", {{"x", int64_t{3}}, {"y", int64_t{2}}, {"size", Size{5, 4}}}, {{"material", image}});
  CHECK(greatest_difference(*part, *make_image({5, 4}, 1, [](int x, int y, int) { return place(x + 3, y + 2, 0); })) ==
        0);
  const ImagePtr rest = run_image("crop", {{"x", int64_t{18}}}, {{"material", image}});
  CHECK(rest->size() == Size{2, 10});
}

TEST_CASE("crop wraps or clamps beyond the border when told to") {
  const ImagePtr image = make_image({4, 3}, 1, place);
  const Params beyond = {{"x", int64_t{-1}}, {"y", int64_t{-1}}, {"size", Size{8, 5}}};
  Params params = beyond;
  params["edges"] = "wrap";
  CHECK(greatest_difference(
            *run_image("crop", params, {{"material", image}}),
            *make_image({8, 5}, 1, [](int x, int y, int) { return place(wrap(x - 1, 4), wrap(y - 1, 3), 0); })) == 0);
  params["edges"] = "clamp";
  CHECK(run_image("crop", params, {{"material", image}})->read({7, 4, 1, 1}).front() == place(3, 2, 0));
  CHECK(error_of("crop", beyond, {{"material", image}}, "size").find("material of 4x3, found 8x5 at x -1, y -1") !=
        std::string::npos);
}

TEST_CASE("crop is the same in tiles and as a whole") {
  check_every_size([](Size size) {
    return run_image("crop", {{"x", int64_t{-9}}, {"y", int64_t{4}}, {"size", size}, {"edges", "wrap"}},
                     {{"material", noise_image({11, 6}, 2)}});
  });
}

TEST_CASE("crop keeps maps of different sizes aligned, or says what would") {
  const MaterialPtr material =
      Material::make("m", {{"height", make_image({16, 16}, 1, place)}, {"roughness", make_image({8, 8}, 1, place)}});
  const auto part =
      run_node("crop", {{"x", int64_t{4}}, {"y", int64_t{2}}, {"size", Size{6, 8}}}, {{"material", {material}}})
          .get<Material>("material");
  CHECK(part->find("height")->size() == Size{6, 8});
  CHECK(part->find("roughness")->size() == Size{3, 4});
  CHECK(part->find("roughness")->read({0, 0, 1, 1}).front() == place(2, 1, 0));
  CHECK_THROWS_WITH_AS(
      run_node("crop", {{"x", int64_t{3}}}, {{"material", {material}}}),
      doctest::Contains("map \"roughness\", which has 8x8 where the material has 16x16; use multiples of 2"), Error);
}
