#include <doctest/doctest.h>

#include "nodes/common/registry.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("a linear gradient runs from edge to edge in its direction") {
  const auto at = [](double angle, int x, int y) {
    const ImagePtr image = run_image("gradient", {{"size", Size{100, 50}}, {"angle", angle}}, {});
    return image->read({x, y, 1, 1}).front();
  };
  CHECK(at(0, 0, 7) == doctest::Approx(0.005));
  CHECK(at(0, 99, 40) == doctest::Approx(0.995));
  CHECK(at(180, 0, 7) == doctest::Approx(0.995));
  CHECK(at(90, 30, 0) == doctest::Approx(0.99));  // to the top
  CHECK(at(90, 30, 49) == doctest::Approx(0.01));
  CHECK(at(45, 0, 49) < 0.02);
  CHECK(at(45, 99, 0) > 0.98);
}

TEST_CASE("a radial gradient runs from the centre to the nearest side") {
  const ImagePtr image = run_image("gradient", {{"size", Size{101, 51}}, {"shape", "radial"}}, {});
  CHECK(image->read({50, 25, 1, 1}).front() == 0);
  CHECK(image->read({50, 0, 1, 1}).front() == doctest::Approx(25 / 25.5));
  CHECK(image->read({0, 25, 1, 1}).front() == 1);
  CHECK(image->read({40, 25, 1, 1}).front() == doctest::Approx(10 / 25.5));
}

TEST_CASE("gradients mix each channel, and need as many at both ends") {
  const ImagePtr image =
      run_image("gradient", {{"size", Size{2, 1}}, {"from", Numbers{1, 0, 0.5}}, {"to", Numbers{0, 1, 0.5}}}, {});
  const std::vector<float> pixels = image->pixels();
  CHECK(pixels[0] == doctest::Approx(0.75));
  CHECK(pixels[1] == doctest::Approx(0.25));
  CHECK(pixels[2] == 0.5f);
  CHECK(pixels[3] == doctest::Approx(0.25));
  CHECK(find_node_type("gradient")->check({{"from", Numbers{1, 2}}, {"to", Numbers{1}}}).front() ==
        "\"to\": expected as many numbers as \"from\" has, 2; found 1");
  check_every_size([](Size size) { return run_image("gradient", {{"size", size}, {"angle", 77.0}}, {}); });
}
