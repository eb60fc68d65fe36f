#include <cmath>

#include <doctest/doctest.h>

#include "core/image/normal.h"
#include "core/image/srgb.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("resize keeps a constant constant with every filter, larger and smaller") {
  const ImagePtr flat = flat_image({13, 9}, {0.25f, 0.5f, 1.0f}, Semantic::base_color, "srgb_texture");
  for (const std::string filter : {"auto", "nearest", "box", "triangle", "mitchell", "lanczos3"})
    for (const Size size : {Size{5, 4}, Size{31, 40}, Size{1, 1}, Size{13, 20}}) {
      const ImagePtr result = run_image("resize", {{"size", size}, {"filter", filter}}, {{"material", flat}});
      CHECK(result->size() == size);
      CHECK(greatest_difference(*result, *flat_image(size, {0.25f, 0.5f, 1.0f})) < 2e-6);
    }
}

TEST_CASE("resize is the same in tiles and as a whole") {
  for (const std::string filter : {"auto", "nearest", "box", "lanczos3"})
    for (const std::string edges : {"clamp", "wrap"})
      check_every_size([&](Size size) {
        const ImagePtr image = noise_image({20, 50}, 3, Semantic::normal);
        return run_image("resize", {{"size", size}, {"filter", filter}, {"edges", edges}}, {{"material", image}});
      });
  check_every_size([](Size size) {
    return run_image("resize", {{"scale", 2.5}},
                     {{"material", noise_image(size, 4, Semantic::base_color, "srgb_texture")}});
  });
}

TEST_CASE("resize by a box of two averages colours in linear light") {
  const ImagePtr stripes = make_image(
      {8, 8}, 3, [](int x, int, int) { return float(x % 2); }, Semantic::base_color, "srgb_texture");
  const ImagePtr half = run_image("resize", {{"scale", 0.5}, {"filter", "box"}}, {{"material", stripes}});
  CHECK(greatest_difference(*half, *flat_image({4, 4}, std::vector<float>(3, float(encode_srgb(0.5))))) < 1e-6);
}

TEST_CASE("resize keeps the mean of an image that wraps") {
  const ImagePtr image = noise_image({32, 32}, 1, Semantic::height);
  const ImagePtr smaller = run_image("resize", {{"size", Size{8, 16}}, {"edges", "wrap"}}, {{"material", image}});
  double before = 0, after = 0;
  for (const float v : image->pixels()) before += v / 1024.0;
  for (const float v : smaller->pixels()) after += v / 128.0;
  CHECK(after == doctest::Approx(before).epsilon(0.002));
}

TEST_CASE("resize filters normals as vectors of unit length") {
  const ImagePtr result =
      run_image("resize", {{"scale", 0.37}}, {{"material", noise_image({30, 30}, 3, Semantic::normal)}});
  const std::vector<float> p = result->pixels();
  for (size_t i = 0; i < p.size(); i += 3) {
    const Vector3f n = decode_normal(&p[i], NormalY::up);
    CHECK(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] == doctest::Approx(1).epsilon(1e-4));
  }
}

TEST_CASE("resize keeps the values of masks") {
  const ImagePtr mask = make_image(
      {16, 16}, 1, [](int x, int y, int) { return float((x ^ y) & 1); }, Semantic::mask);
  for (const float v : run_image("resize", {{"size", Size{23, 7}}}, {{"material", mask}})->pixels())
    CHECK((v == 0 || v == 1));
}

TEST_CASE("resize keeps 8-bit maps within what the file can hold, and float maps as filtered") {
  const ImagePtr edge = make_image(
      {16, 16}, 1, [](int x, int, int) { return float(x > 7); }, Semantic::height);
  const auto lowest = [](const ImagePtr& image) {
    const std::vector<float> p = image->pixels();
    return *std::min_element(p.begin(), p.end());
  };
  const Params params = {{"scale", 3.0}, {"filter", "lanczos3"}};
  CHECK(lowest(run_image("resize", params, {{"material", edge}})) < -0.01f);
  CHECK(lowest(run_image("resize", params, {{"material", with_depth(edge, Depth::u8)}})) == 0);
}

TEST_CASE("resize takes a missing side from the material's proportions, and only the maps asked for") {
  const MaterialPtr material = Material::make("m", {{"height", noise_image({40, 20}, 1, Semantic::height)},
                                                    {"roughness", noise_image({20, 10}, 1, Semantic::roughness)}});
  const auto all = run_node("resize", {{"size", Size{10, 0}}}, {{"material", {material}}}).get<Material>("material");
  CHECK(all->find("height")->size() == Size{10, 5});
  CHECK(all->find("roughness")->size() == Size{10, 5});
  const auto scaled = run_node("resize", {{"scale", 0.5}}, {{"material", {material}}}).get<Material>("material");
  CHECK(scaled->find("height")->size() == Size{20, 10});
  CHECK(scaled->find("roughness")->size() == Size{10, 5});
  const auto one = run_node("resize", {{"size", Size{0, 20}}, {"maps", Texts{"roughness"}}}, {{"material", {material}}})
                       .get<Material>("material");
  CHECK(one->find("height") == material->find("height"));
  CHECK(one->find("roughness")->size() == Size{40, 20});
}

TEST_CASE("resize names the maps there are when one is missing") {
  const std::string message = error_of("resize", {{"maps", Texts{"hight"}}},
                                       {{"material", flat_image({4, 4}, {1}, Semantic::height)}}, "maps.0");
  CHECK(message.find("no map \"hight\" (did you mean \"height\"?); the material has height") != std::string::npos);
}
