#include <cmath>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/image/srgb.h"
#include "nodes/common/registry.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

MaterialPtr converted(const MaterialPtr& material, const std::string& to) {
  return run_node("convert_workflow", {{"to", to}}, {{"material", {material}}}).get<Material>("material");
}

std::string names(const Material& material) {
  return material.map_names();
}

/// Colours of 0.2 and more, half transparent, and everything from dielectric to metal.
MaterialPtr mixed(const std::string& color_space) {
  const ImagePtr base = make_image(
      {11, 7}, 4, [](int x, int y, int c) { return c == 3 ? 0.5f : 0.2f + 0.07f * float((x * (c + 2) + y) % 12); },
      Semantic::base_color, color_space);
  const ImagePtr metallic = make_image(
      {11, 7}, 1, [](int x, int, int) { return float(x) / 10; }, Semantic::metallic);
  return Material::make("m", {{"base_color", base},
                              {"roughness", noise_image({11, 7}, 1, Semantic::roughness)},
                              {"metallic", metallic},
                              {"height", noise_image({22, 14}, 1, Semantic::height)}});
}

}  // namespace

TEST_CASE("there and back gives base colour and metallic again, and keeps other maps as they are") {
  for (const std::string space : {"srgb_texture", "lin_rec709"}) {
    const MaterialPtr before = mixed(space), specular = converted(before, "specular");
    CHECK(names(*specular) == "base_color, roughness, specular, height");
    CHECK(specular->find("specular")->info().semantic == Semantic::specular);
    CHECK(specular->find("specular")->info().color_space == space);
    CHECK(specular->find("specular")->channels() == 3);
    const MaterialPtr after = converted(specular, "metallic");
    CHECK(names(*after) == names(*before));
    CHECK(greatest_difference(*before->find("base_color"), *after->find("base_color")) < 2e-4);
    CHECK(greatest_difference(*before->find("metallic"), *after->find("metallic")) < 2e-4);
    CHECK(after->find("height") == before->find("height"));
    CHECK(after->find("roughness") == before->find("roughness"));
  }
}

TEST_CASE("colours count in linear light") {
  const MaterialPtr half =
      Material::make("m", {{"base_color", flat_image({1, 1}, {0.5f, 0.5f, 0.5f}, Semantic::base_color, "srgb_texture")},
                           {"metallic", flat_image({1, 1}, {0.5f}, Semantic::metallic)}});
  const double base = decode_srgb(0.5), reflected = 0.02 + base / 2;
  const MaterialPtr specular = converted(half, "specular");
  CHECK(specular->find("specular")->pixels().front() == doctest::Approx(encode_srgb(reflected)));
  CHECK(specular->find("base_color")->pixels().front() == doctest::Approx(encode_srgb(base * 0.48 / (1 - reflected))));
}

TEST_CASE("a grey specular map of another size will do, and a metallic map that is there is replaced") {
  const MaterialPtr material =
      Material::make("m", {{"metallic", flat_image({1, 1}, {0.9f}, Semantic::metallic)},
                           {"base_color", flat_image({4, 4}, {0.3f, 0.3f, 0.3f}, Semantic::base_color, "lin_rec709")},
                           {"specular", flat_image({2, 2}, {0.04f}, Semantic::specular, "lin_rec709")}});
  const MaterialPtr metallic = converted(material, "metallic");
  CHECK(names(*metallic) == "base_color, metallic");
  for (const float v : metallic->find("metallic")->pixels()) CHECK(v == doctest::Approx(0).epsilon(1e-5));
  for (const float v : metallic->find("base_color")->pixels()) CHECK(v == doctest::Approx(0.3));
}

TEST_CASE("convert_workflow is the same in tiles") {
  for (const char* map : {"base_color", "specular"})
    check_every_size([&](Size size) {
      const MaterialPtr material =
          Material::make("m", {{"base_color", noise_image(size, 3, Semantic::base_color, "srgb_texture")},
                               {"metallic", noise_image(size, 1, Semantic::metallic, "raw", 2)}});
      return converted(material, "specular")->find(map);
    });
}

TEST_CASE("what is lacking, or of other primaries, is said") {
  const MaterialPtr lacks = Material::of(flat_image({2, 2}, {0, 0, 0}, Semantic::base_color, "srgb_texture"));
  CHECK(test::error_of("convert_workflow", {}, {{"material", {lacks}}}).find("specular") != std::string::npos);
  const MaterialPtr odd =
      Material::make("m", {{"base_color", flat_image({1, 1}, {0, 0, 0}, Semantic::base_color, "acescg")},
                           {"specular", flat_image({1, 1}, {0, 0, 0}, Semantic::specular, "srgb_texture")}});
  CHECK(test::error_of("convert_workflow", {}, {{"material", {odd}}}).find("found acescg and srgb_texture") !=
        std::string::npos);
}

TEST_CASE("the maps of the result are known before anything runs, and what is certainly lacking is refused") {
  const NodeType* type = find_node_type("convert_workflow");
  const Forecast material{.maps = {"base_color", "specular", "height"}, .possible_maps = Texts{}};
  const Forecast made = type->infer({{"to", "metallic"}}, {{"material", {material}}}).at("material");
  CHECK(made.maps == Texts{"base_color", "height", "metallic"});
  CHECK_THROWS_AS(type->infer({{"to", "specular"}}, {{"material", {material}}}), Error);
  CHECK_NOTHROW(type->infer({{"to", "specular"}}, {{"material", {Forecast{}}}}));
}
