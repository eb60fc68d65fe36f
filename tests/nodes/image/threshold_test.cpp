#include <cmath>

#include <doctest/doctest.h>

#include "core/image/distribution.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("threshold makes a mask of what is at or above the value") {
  const ImagePtr ramp = make_image(
      {5, 1}, 1, [](int x, int, int) { return float(x) / 4; }, Semantic::height);
  const ImagePtr mask = run_image("threshold", {}, {{"image", ramp}});
  CHECK(mask->info().semantic == Semantic::mask);
  CHECK(mask->pixels() == std::vector<float>{0, 0, 1, 1, 1});
  CHECK(run_image("threshold", {{"inverted", true}}, {{"image", ramp}})->pixels() == std::vector<float>{1, 1, 0, 0, 0});
  const std::vector<float> soft = run_image("threshold", {{"softness", 1.0}}, {{"image", ramp}})->pixels();
  CHECK(soft == std::vector<float>{0, 0.15625f, 0.5f, 0.84375f, 1});
}

TEST_CASE("the automatic threshold is Otsu's") {
  // Six grey levels with counts 8 7 2 6 9 4: the greatest variance between classes parts 0 1 2 from 3 4 5.
  const std::vector<int> counts = {8, 7, 2, 6, 9, 4};
  std::vector<float> values;
  for (int level = 0; level < 6; level++) values.insert(values.end(), counts[level], float(level));
  const ImagePtr image = make_image({6, 6}, 1, [&](int x, int y, int) { return values[y * 6 + x]; });
  CHECK(Distribution::of(*image, Task()).front().otsu_threshold() == 2.5);
  const NodeRun run = run_node("threshold", {{"auto", true}}, {{"image", {image}}});
  CHECK(run.notes == std::vector<std::string>{"threshold 2.5"});
  double light = 0;
  for (const float v : run.get<Image>("mask")->pixels()) light += v;
  CHECK(light == 6 + 9 + 4);
}

TEST_CASE("threshold is the same in tiles and on any number of threads") {
  check_every_size([](Size size) {
    return run_image("threshold", {{"auto", true}, {"softness", 0.3}}, {{"image", noise_image(size, 1)}});
  });
}

TEST_CASE("threshold wants one channel and says how to get it") {
  CHECK(error_of("threshold", {}, {{"image", flat_image({2, 3}, {0, 0, 0})}}, "image").find("put \"grayscale\"") !=
        std::string::npos);
}
