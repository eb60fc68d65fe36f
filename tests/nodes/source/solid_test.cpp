#include <array>

#include <doctest/doctest.h>

#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("a solid image is its value everywhere, with as many channels") {
  const ImagePtr image =
      run_image("solid", {{"value", Numbers{0.25, 0.5, 1}}, {"size", Size{7, 3}}, {"semantic", "base_color"}}, {});
  CHECK(image->size() == Size{7, 3});
  REQUIRE(image->channels() == 3);
  CHECK(image->info().color_space == "srgb_texture");
  const std::vector<float> pixels = image->pixels();
  for (size_t i = 0; i < pixels.size(); i++) CHECK(pixels[i] == std::array{0.25f, 0.5f, 1.0f}[i % 3]);
  CHECK(run_image("solid", {}, {})->info().color_space == "raw");
  check_every_size([](Size size) { return run_image("solid", {{"size", size}}, {}); });
}
