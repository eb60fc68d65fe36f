#include "core/picture/render/textures.h"

#include <cmath>

#include <doctest/doctest.h>

#include "core/image/normal.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::render;

namespace {

/// Rolling hills that tile.
ImagePtr hills(Size size) {
  return test::make_image(
      size, 1,
      [size](int x, int y, int) {
        return float(0.5 + 0.25 * std::sin(6.2831853 * x / size.width * 3) +
                     0.25 * std::cos(6.2831853 * y / size.height * 2));
      },
      Semantic::height);
}

}  // namespace

TEST_CASE("the relief's depth is found again from normals and height") {
  const Size size{64, 48};
  const ImagePtr height = hills(size);
  for (const double pixels : {2.0, 6.0}) {
    const ImageInfo info{.size = size, .channels = 3, .semantic = Semantic::normal};
    std::vector<float> normals(size_t(size.area()) * 3);
    normals_from_height(*height, {0, 0, size.width, size.height}, pixels, SlopeFilter::central, Outside::wrap,
                        NormalY::up, normals.data());
    const ImagePtr normal = Image::from_floats(info, std::move(normals));
    const MaterialPtr m = Material::make("hills", {{"normal", normal}, {"height", height}});
    CHECK(load_textures(*m, 64, 1, Task()).depth == doctest::Approx(pixels / 64).epsilon(0.05));
    CHECK(load_textures(*m, 64, 2, Task()).depth == doctest::Approx(2 * pixels / 64).epsilon(0.05));
  }
  CHECK(load_textures(*Material::of(height), 64, 1, Task()).depth == doctest::Approx(0.05));
}

TEST_CASE("textures wrap, meet texels at their centres and average down") {
  const Texture t({2, 1}, 1, {0.f, 1.f});
  CHECK(t.value(0.25, 0.5) == 0);
  CHECK(t.value(0.75, 7.5) == 1);
  CHECK(t.value(0.5, 0) == doctest::Approx(0.5));
  CHECK(t.value(1.0, 0) == doctest::Approx(0.5));
  CHECK(t.value(-0.75, 0) == 0);

  const ImagePtr stripes = test::make_image(
      {10, 6}, 1, [](int x, int, int) { return float(x % 2); }, Semantic::roughness);
  const Textures small = load_textures(*Material::of(stripes), 5, 1, Task());
  CHECK(small.roughness.size() == Size{5, 3});
  CHECK(small.at(0.3, 0.4).roughness == doctest::Approx(0.5));
}

TEST_CASE("colours are decoded to linear light before they are averaged") {
  const ImagePtr checks = test::make_image(
      {2, 2}, 3, [](int x, int y, int) { return float((x + y) % 2); }, Semantic::base_color, "srgb_texture");
  CHECK(load_textures(*Material::of(checks), 1, 1, Task()).at(0.5, 0.5).albedo.x() == doctest::Approx(0.5));
  const ImagePtr grey = test::make_image(
      {2, 2}, 3, [](int, int, int) { return 0.5f; }, Semantic::base_color, "srgb_texture");
  CHECK(load_textures(*Material::of(grey), 2, 1, Task()).at(0.2, 0.5).albedo.y() ==
        doctest::Approx(0.21404).epsilon(1e-4));
}
