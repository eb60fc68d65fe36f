#include <doctest/doctest.h>

#include "nodes/common/registry.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("values are remapped by the curve, alpha is not") {
  const Params bent{{"points", Numbers{0, 1, 0.5, 0.25, 1, 0}}, {"interpolation", "linear"}};
  const ImagePtr result =
      run_image("curve", bent, {{"image", flat_image({2, 2}, {0.25f, 0.5f, 2, 0.75f}, Semantic::base_color)}});
  CHECK(result->pixels()[0] == doctest::Approx(0.625));
  CHECK(result->pixels()[1] == doctest::Approx(0.25));
  CHECK(result->pixels()[2] == 0);
  CHECK(result->pixels()[3] == doctest::Approx(0.75));
  const ImagePtr image = noise_image({9, 9}, 3);
  CHECK(greatest_difference(*run_image("curve", {}, {{"image", image}}), *image) < 1e-6);
}

TEST_CASE("points that make no curve are refused, and normals are not remapped") {
  const auto check = [](const Numbers& points) {
    Params params = {{"points", points}, {"interpolation", "smooth"}};
    return find_node_type("curve")->check(params);
  };
  CHECK(check({0, 0, 1, 1}).empty());
  CHECK(check({0, 0, 1}).front() == "\"points\": expected pairs of numbers, x and y; found 3 numbers");
  CHECK(check({0, 0, 0.5, 1, 0.5, 0}).front() ==
        "\"points\": expected each x above the one before; found 0.5 after 0.5");
  CHECK_FALSE(error_of("curve", {}, {{"image", noise_image({4, 4}, 3, Semantic::normal)}}, "image").empty());
}

TEST_CASE("a curve is the same in tiles and as a whole") {
  check_every_size([](Size size) {
    return run_image("curve", {{"points", Numbers{0, 0.2, 0.3, 0.9, 1, 0.1}}}, {{"image", noise_image(size, 3)}});
  });
}
