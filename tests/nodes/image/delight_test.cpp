#include <cmath>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/image/srgb.h"
#include "nodes/common/registry.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

MaterialPtr delighted(const MaterialPtr& material, const Params& params = {}) {
  return run_node("delight", params, {{"material", {material}}}).get<Material>("material");
}

/// Noise that is half as bright on the right; in sRGB, half transparent.
ImagePtr sunny(Size size, int channels = 4) {
  const ImagePtr noise = noise_image(size, 1);
  const std::vector<float> tones = noise->pixels();
  return make_image(
      size, channels,
      [&](int x, int y, int c) {
        if (c == 3) return 0.5f;
        const double tone = 0.2 + 0.2 * double(tones[size_t(y * size.width + x)]);
        return float(encode_srgb(tone * (1 - 0.5 * x / size.width)));
      },
      Semantic::base_color, "srgb_texture");
}

/// The mean in linear light of columns.
double brightness(const Image& image, int from, int to) {
  double sum = 0;
  for (int y = 0; y < image.height(); y++)
    for (int x = from; x < to; x++) sum += decode_srgb(image.read({x, y, 1, 1})[1]);
  return sum / (image.height() * (to - from));
}

}  // namespace

TEST_CASE("delight evens out the base colour in linear light, and no other map") {
  const MaterialPtr before = Material::make("m", {{"base_color", sunny({96, 64})},
                                                  {"roughness", noise_image({96, 64}, 1, Semantic::roughness)},
                                                  {"height", noise_image({48, 32}, 1, Semantic::height)}});
  const NodeRun run = run_node("delight", {}, {{"material", {before}}});
  const MaterialPtr after = run.get<Material>("material");
  CHECK(run.says("slow light: the brightest place had"));
  CHECK(after->map_names() == before->map_names());
  CHECK(after->find("roughness") == before->find("roughness"));
  CHECK(after->find("height") == before->find("height"));
  const Image &dark = *before->find("base_color"), &even = *after->find("base_color");
  CHECK(even.info() == dark.info());
  CHECK(even.read({5, 5, 1, 1})[3] == 0.5f);
  CHECK(brightness(dark, 0, 16) / brightness(dark, 80, 96) > 1.5);
  CHECK(brightness(even, 0, 16) / brightness(even, 80, 96) == doctest::Approx(1).epsilon(0.08));
  CHECK(brightness(even, 0, 96) == doctest::Approx(brightness(dark, 0, 96)).epsilon(0.05));
}

TEST_CASE("strength scales what is taken out, and without light the material passes") {
  const MaterialPtr lit = Material::of(sunny({96, 64}));
  CHECK(delighted(lit, {{"strength", 0.0}}) == lit);
  const double all = brightness(*delighted(lit)->find("base_color"), 80, 96);
  const double half = brightness(*delighted(lit, {{"strength", 0.5}})->find("base_color"), 80, 96);
  const double none = brightness(*lit->find("base_color"), 80, 96);
  CHECK(half / none == doctest::Approx(std::sqrt(all / none)).epsilon(0.03));

  const MaterialPtr even = Material::of(noise_image({96, 64}, 3, Semantic::base_color, "srgb_texture"));
  const NodeRun run = run_node("delight", {}, {{"material", {even}}});
  CHECK(run.get<Material>("material")->find("base_color") == even->find("base_color"));
  CHECK(run.says("no slow light"));
}

TEST_CASE("delight finds the light that preview lit a generated wall with, in either convention of normals") {
  const MaterialPtr wall =
      run_node("pattern", {{"kind", "cobbles"}, {"size", Size{128, 128}}, {"scale", 8.0}}).get<Material>("material");
  const ImagePtr lit =
      run_node("preview", {{"azimuth", 135.0}, {"elevation", 45.0}, {"size", Size{128, 128}}}, {{"material", {wall}}})
          .get<Image>("image");
  const ImagePtr normal = wall->find("normal");
  const ImagePtr turned =
      run_node("convert_normal", {{"normal_y", "down"}}, {{"normal", {normal}}}).get<Image>("normal");
  for (const Map& hint : {Map{"normal", normal}, Map{"normal", turned}, Map{"height", wall->find("height")}}) {
    const MaterialPtr photo = Material::make("m", {{"base_color", lit}, hint});
    const NodeRun run = run_node("delight", {}, {{"material", {photo}}});
    CAPTURE(hint.name);
    REQUIRE(run.says("light on the relief: from 13"));  // 130 to 139 degrees
    const ImagePtr even = run.get<Material>("material")->find("base_color");
    CHECK(greatest_difference(*even, *lit) > 0.05);
    CHECK(delighted(photo, {{"relief", 0.0}, {"strength", 0.0}}) == photo);
  }
}

TEST_CASE("delight is the same in tiles, at any size") {
  check_every_size([&](Size size) { return delighted(Material::of(sunny(size)))->find("base_color"); });
  check_tiles_agree(*delighted(Material::of(sunny({96, 64})))->find("base_color"));
  check_tiles_agree(
      *delighted(Material::of(sunny({70, 40}, 3)), {{"detail", int64_t{4}}, {"edges", "wrap"}})->find("base_color"));
  check_tiles_agree(*delighted(Material::of(sunny({64, 64}, 1)))->find("base_color"));
}

TEST_CASE("a material that certainly lacks a base colour is refused ahead") {
  const NodeType* type = find_node_type("delight");
  const Forecast lacks{.maps = {"height"}, .possible_maps = Texts{}};
  CHECK_THROWS_AS(type->infer({}, {{"material", {lacks}}}), Error);
  const Forecast has{.maps = {"base_color", "height"}, .possible_maps = Texts{}};
  CHECK(type->infer({}, {{"material", {has}}}).at("material").maps == has.maps);
}
