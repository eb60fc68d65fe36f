#include "core/analysis/space/weighting.h"

#include <doctest/doctest.h>

#include "core/analysis/space/planes.h"
#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

MaterialPtr wall_material() {
  const ImagePtr height = make_image(
      {32, 32}, 1, [](int x, int y, int) { return float((x * y) % 7) / 7; }, Semantic::height);
  return Material::make("wall", {{"base_color", wall({32, 32})}, {"height", height}});
}

ImagePtr normals(NormalY normal_y) {
  const ImagePtr image = make_image(
      {16, 16}, 3,
      [normal_y](int x, int y, int c) {
        const float value = c == 2 ? 0.9f : 0.5f + 0.02f * float((c == 0 ? x : y) % 8);
        return c == 1 && normal_y == NormalY::down ? 1.0f - value : value;
      },
      Semantic::normal);
  ImageInfo info = image->info();
  info.normal_y = normal_y;
  return Image::redescribed(image, info);
}

}  // namespace

TEST_CASE("weights choose maps and channels") {
  CHECK(weighted_features(*wall_material(), {}, false)->channel_count() == 4);
  CHECK(weighted_features(*wall_material(), {{"base_color", {0}}}, false)->channel_count() == 1);
  CHECK(weighted_features(*wall_material(), {{"base_color", {1, 0, 0.5}}}, false)->channel_count() == 3);
}

TEST_CASE("wrong weights are refused with what would do") {
  CHECK_THROWS_WITH_AS(weighted_features(*wall_material(), {{"heigth", {1}}}, false),
                       "there is no map \"heigth\" (did you mean \"height\"?); the material has base_color, height",
                       Error);
  CHECK_THROWS_WITH_AS(weighted_features(*wall_material(), {{"base_color", {1, 2}}}, false),
                       "\"base_color\" has 3 channels in analysis space, but 2 weights were given; give one or 3",
                       Error);
  CHECK_THROWS_AS(weighted_features(*wall_material(), {{"base_color", {0}}, {"height", {0}}}, false), Error);
}

TEST_CASE("a weight of 1 gives every map the same variance, whatever its range") {
  const FeaturesPtr f = weighted_features(*wall_material(), {{"base_color", {1}}, {"height", {1}}}, false);
  const Planes planes = *weighted_planes(*f, Task());
  double color = 0, height = 0;
  for (size_t i = 0; i < planes.values.size(); i++)
    (i % 4 == 3 ? height : color) += double(planes.values[i]) * planes.values[i];
  CHECK(color == doctest::Approx(height).epsilon(1e-3));
}

TEST_CASE("weighted channels are made once for all who hold them, whatever repeats are known") {
  const FeaturesPtr f = weighted_features(*wall_material(), {{"base_color", {1}}, {"height", {1}}}, false);
  const auto first = weighted_planes(*f, Task());
  CHECK(weighted_planes(*f, Task()) == first);
  CHECK(weighted_planes(*f->with(Repeats(Lattice{1, {0, 8}, {}, 1})), Task()) == first);
  const ImagePtr half = Image::from_floats({.size = f->size(), .channels = 1, .semantic = Semantic::mask},
                                           std::vector<float>(size_t(f->size().area()), 1.0f));
  CHECK(weighted_planes(*f->with(half), Task()) != first);
}

TEST_CASE("OpenGL and DirectX normals of one surface are the same features") {
  const std::vector<float> up = analysis_image(normals(NormalY::up))->pixels();
  const std::vector<float> down = analysis_image(normals(NormalY::down))->pixels();
  for (size_t i = 0; i < up.size(); i++) REQUIRE(up[i] == doctest::Approx(down[i]).epsilon(1e-5));
}
