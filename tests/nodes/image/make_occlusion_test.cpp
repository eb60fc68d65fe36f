#include <doctest/doctest.h>

#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

ImagePtr occlusion(const ImagePtr& height, Params params = {}) {
  return run_image("make_occlusion", params, {{"height", height}});
}

}  // namespace

TEST_CASE("all of the sky is seen from a flat plane") {
  const ImagePtr flat = occlusion(flat_image({9, 7}, {0.3f}, Semantic::height));
  CHECK(flat->info().semantic == Semantic::ambient_occlusion);
  for (const float v : flat->pixels()) CHECK(v == 1);
}

TEST_CASE("the bottom of a pit is darker than its surroundings, and a deeper pit darker still") {
  const auto bottom = [](double depth) {
    const ImagePtr pit = make_image(
        {31, 31}, 1, [](int x, int y, int) { return (x - 15) * (x - 15) + (y - 15) * (y - 15) < 9 ? 0.0f : 1.0f; },
        Semantic::height);
    const ImagePtr image = occlusion(pit, {{"height_scale", depth}, {"radius", int64_t{8}}});
    CHECK(image->read({0, 0, 1, 1}).front() == 1);
    return image->read({15, 15, 1, 1}).front();
  };
  CHECK(bottom(2) < 0.9f);
  CHECK(bottom(10) < 0.5f * bottom(2));
}

TEST_CASE("beside a tall wall half of the sky is left") {
  const ImagePtr wall = make_image(
      {41, 41}, 1, [](int x, int, int) { return float(x > 20); }, Semantic::height);
  const float seen =
      occlusion(wall, {{"height_scale", 10000.0}, {"radius", int64_t{12}}})->read({20, 20, 1, 1}).front();
  // Of 16 directions 7 meet the wall and 2 run along it.
  CHECK(seen == doctest::Approx(9.0 / 16).epsilon(1e-3));
}

TEST_CASE("strength scales the darkening") {
  const ImagePtr bumps = noise_image({16, 16}, 1, Semantic::height);
  const std::vector<float> full = occlusion(bumps, {{"height_scale", 1.0}})->pixels();
  const std::vector<float> half = occlusion(bumps, {{"height_scale", 1.0}, {"strength", 0.5}})->pixels();
  for (size_t i = 0; i < full.size(); i++) CHECK(1 - half[i] == doctest::Approx((1 - full[i]) / 2).epsilon(1e-4));
}

TEST_CASE("occlusion wraps: shifting the height map shifts the result") {
  const ImagePtr bumps = noise_image({16, 12}, 1, Semantic::height);
  const Params shift = {{"x", int64_t{5}}, {"y", int64_t{3}}, {"size", Size{16, 12}}, {"edges", "wrap"}};
  const Params params = {{"edges", "wrap"}, {"radius", int64_t{6}}};
  const ImagePtr shifted_first = occlusion(run_image("crop", shift, {{"material", bumps}}), params);
  const ImagePtr shifted_last = run_image("crop", shift, {{"material", occlusion(bumps, params)}});
  CHECK(greatest_difference(*shifted_first, *shifted_last) == 0);
}

TEST_CASE("occlusion is the same on any number of threads") {
  check_every_size([](Size size) {
    return occlusion(noise_image(size, 1, Semantic::height), {{"radius", int64_t{9}}, {"edges", "wrap"}});
  });
}

TEST_CASE("make_occlusion wants one channel") {
  CHECK(error_of("make_occlusion", {}, {{"height", flat_image({2, 2}, {0, 0})}}, "height").find("2 channels") !=
        std::string::npos);
}
