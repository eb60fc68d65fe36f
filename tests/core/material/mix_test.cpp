#include "core/material/mix.h"

#include <cmath>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/image/normal.h"
#include "core/image/srgb.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr Size size{40, 24};

ImagePtr flat_normals(const Vector3f& n, NormalY normal_y, const Size& of = size) {
  ImageInfo info{.size = of, .channels = 3, .semantic = Semantic::normal};
  info.normal_y = normal_y;
  std::vector<float> pixels(size_t(of.area()) * 3);
  for (size_t i = 0; i < pixels.size(); i += 3) encode_normal(normalized(n), normal_y, &pixels[i]);
  return Image::from_floats(info, std::move(pixels));
}

/// Constant maps of every kind.
MaterialPtr constant(float color, float height, float other, const Vector3f& normal, NormalY normal_y = NormalY::up) {
  return Material::make("m",
                        {{"base_color", flat_image(size, {color, color, color}, Semantic::base_color, "srgb_texture")},
                         {"normal", flat_normals(normal, normal_y)},
                         {"height", flat_image(size, {height}, Semantic::height)},
                         {"roughness", flat_image(size, {other}, Semantic::roughness)},
                         {"mask", flat_image(size, {other}, Semantic::mask)}});
}

MaterialPtr noisy(unsigned seed) {
  return Material::make("n",
                        {{"base_color", noise_image(size, 3, Semantic::base_color, "srgb_texture", seed)},
                         {"normal", noise_image(size, 3, Semantic::normal, "raw", seed + 1)},
                         {"height", noise_image(size, 1, Semantic::height, "raw", seed + 2)},
                         {"ambient_occlusion", noise_image(size, 1, Semantic::ambient_occlusion, "raw", seed + 3)}});
}

/// White from column 20 on.
ImagePtr halves(const Size& of = size) {
  return make_image(of, 1, [&](int x, int, int) { return 2 * x < of.width ? 0.f : 1.f; });
}

float at(const Mix& mix, const char* map, int x, int y = 12, int channel = 0) {
  return mix.material->find(map)->read({x, y, 1, 1})[size_t(channel)];
}

Vector3f normal_at(const Mix& mix, int x) {
  const ImagePtr map = mix.material->find("normal");
  return decode_normal(map->read({x, 12, 1, 1}).data(), map->info().normal_y);
}

}  // namespace

TEST_CASE("a hard border shows each material's own pixels, and so does one without width") {
  const MaterialPtr a = noisy(1), b = noisy(50);
  for (const Border border : {Border::hard, Border::soft, Border::height}) {
    const Mix mix = mixed({a, b}, halves(), {.border = border, .width = border == Border::hard ? 16.0 : 0.0});
    for (const Map& m : mix.material->maps()) {
      CHECK(m.image->read({0, 0, 20, 24}) == a->find(m.name)->read({0, 0, 20, 24}));
      CHECK(m.image->read({20, 0, 20, 24}) == b->find(m.name)->read({20, 0, 20, 24}));
    }
  }
}

TEST_CASE("beyond half its width a border changes no bit") {
  const MaterialPtr a = noisy(1), b = noisy(50);
  for (const Border border : {Border::soft, Border::height}) {
    const Mix mix = mixed({a, b}, halves(), {.border = border, .width = 10});
    for (const Map& m : mix.material->maps()) {
      CHECK(m.image->read({0, 0, 15, 24}) == a->find(m.name)->read({0, 0, 15, 24}));
      CHECK(m.image->read({25, 0, 15, 24}) == b->find(m.name)->read({25, 0, 15, 24}));
      CHECK(m.image->read({16, 0, 8, 24}) != a->find(m.name)->read({16, 0, 8, 24}));
    }
  }
}

TEST_CASE("across a soft border constants are mixed by a smooth step of the distance") {
  const Mix mix = mixed({constant(0.2f, 0.3f, 0.1f, {0, 0, 1}), constant(0.8f, 0.7f, 0.9f, {0, 0, 1})}, halves(),
                        {.border = Border::soft, .width = 8});
  for (const int x : {15, 16, 18, 19, 20, 22, 24}) {
    CAPTURE(x);
    const double t = std::clamp(0.5 + (x - 19.5) / 8, 0.0, 1.0), share = t * t * (3 - 2 * t);
    CHECK(at(mix, "height", x) == doctest::Approx(0.3 + share * 0.4));
    CHECK(at(mix, "roughness", x) == doctest::Approx(0.1 + share * 0.8));
    // Colours in linear light.
    const double light = (1 - share) * decode_srgb(0.2f) + share * decode_srgb(0.8f);
    CHECK(at(mix, "base_color", x) == doctest::Approx(encode_srgb(light)));
    // A mask may hold labels.
    CHECK(at(mix, "mask", x) == (x < 20 ? 0.1f : 0.9f));
  }
}

TEST_CASE("normals are mixed as vectors, in the first material's convention, and have unit length") {
  const Vector3f up = normalized({0, 1, 1}), right = normalized({1, 0, 1});
  const Mix mix = mixed({constant(0, 0, 0, up, NormalY::down), constant(0, 0, 0, right, NormalY::up)}, halves(),
                        {.border = Border::soft, .width = 12});
  CHECK(mix.material->find("normal")->info().normal_y == NormalY::down);
  for (int x = 12; x < 28; x++) {
    const double t = std::clamp(0.5 + (x - 19.5) / 12, 0.0, 1.0), share = t * t * (3 - 2 * t);
    const Vector3f expected = normalized(up + float(share) * (right - up));
    CHECK((normal_at(mix, x) - expected).norm() < 1e-5f);
    CHECK(length(normal_at(mix, x)) == doctest::Approx(1).epsilon(1e-5));
  }
  const Mix noise = mixed({noisy(1), noisy(2)}, halves(), {.border = Border::soft, .width = 12});
  for (int x = 14; x < 26; x++) CHECK(length(normal_at(noise, x)) == doctest::Approx(1).epsilon(1e-5));
}

TEST_CASE("by height the higher one shows about the border, and heights have no steps") {
  // Ridges four columns wide across low ground.
  const auto ridges = [](float ground, float ridge) {
    const auto height = [=](int x, int, int) { return x % 8 < 4 ? ridge : ground; };
    const auto shade = [=](int x, int, int) { return x % 8 < 4 ? 1.f : 0.f; };
    return Material::make("r", {{"height", make_image(size, 1, height, Semantic::height)},
                                {"roughness", make_image(size, 1, shade, Semantic::roughness)}});
  };
  const auto plain = Material::make("p", {{"height", flat_image(size, {0.5f}, Semantic::height)},
                                          {"roughness", flat_image(size, {0.4f}, Semantic::roughness)}});
  const MixOptions options{.border = Border::height, .width = 24, .softness = 0};
  const Mix mix = mixed({plain, ridges(0.2f, 0.9f)}, halves(), options);
  // The ridge at 16..19 stands out of the first material, where the second has no business by the map.
  CHECK(at(mix, "roughness", 17) == 1.f);
  CHECK(at(mix, "height", 17) < 0.9f);  // it has sunk a little
  CHECK(at(mix, "height", 17) > 0.88f);
  // The ground at 20..23 is lower than the first material, which shows there.
  CHECK(at(mix, "roughness", 21) == 0.4f);
  CHECK(at(mix, "height", 21) == doctest::Approx(0.5).epsilon(0.01));
  CHECK(at(mix, "roughness", 25) == 1.f);
  // At the far ends of the border nothing of the other shows.
  CHECK(at(mix, "roughness", 8) == 0.4f);
  CHECK(at(mix, "roughness", 29) == 0.f);
  // The labels say who shows.
  CHECK(mix.labels->read({17, 3, 5, 1}) == std::vector<float>{1, 1, 1, 0, 0});
}

TEST_CASE("heights go through a border by height without a step") {
  const auto slope = [](float from, float by) {
    return Material::make(
        "s", {{"height", make_image(
                             size, 1, [=](int x, int, int) { return from + by * float(x); }, Semantic::height)}});
  };
  for (const double softness : {0.0, 0.1, 0.5}) {
    const Mix mix = mixed({slope(0.3f, 0.002f), slope(0.75f, 0.001f)}, halves(),
                          {.border = Border::height, .width = 30, .softness = softness});
    const std::vector<float> row = mix.material->find("height")->read({0, 12, 40, 1});
    for (size_t x = 1; x < row.size(); x++) CHECK(std::fabs(row[x] - row[x - 1]) < 0.12f);
  }
}

TEST_CASE("offset lets one material win, and softness decides how sharply") {
  const MaterialPtr a = constant(0.5f, 0.6f, 0, {0, 0, 1}), b = constant(0.5f, 0.4f, 1, {0, 0, 1});
  const auto second = [&](double offset, double softness, int x) {
    return at(mixed({a, b}, halves(), {.border = Border::height, .width = 20, .softness = softness, .offset = offset}),
              "roughness", x);
  };
  CHECK(second(0, 0, 21) == 0);  // the first is higher
  CHECK(second(0, 0, 30) == 1);
  CHECK(second(1, 0, 21) == 1);  // both count alike
  CHECK(second(1, 0, 18) == 0);
  const float soft = second(1, 1, 21);
  CHECK(soft > 0.3f);
  CHECK(soft < 0.7f);
}

TEST_CASE("a border goes on across the edges where the materials wrap") {
  const MaterialPtr a = constant(0.2f, 0.3f, 0, {0, 0, 1}), b = constant(0.8f, 0.7f, 1, {0, 0, 1});
  const MixOptions open{.border = Border::soft, .width = 8},
      around{.border = Border::soft, .width = 8, .wraps_x = true};
  CHECK(at(mixed({a, b}, halves(), open), "roughness", 0) == 0);
  CHECK(at(mixed({a, b}, halves(), open), "roughness", 39) == 1);
  const Mix mix = mixed({a, b}, halves(), around);
  for (int x = 0; x < 8; x++) {
    CHECK(at(mix, "roughness", x) == doctest::Approx(at(mix, "roughness", 39 - x) * -1 + 1));
    CHECK(at(mix, "roughness", x) == doctest::Approx(1 - at(mix, "roughness", 20 + x)));  // half a turn on
  }
  CHECK(at(mix, "roughness", 0) > 0.3f);
  const Mix wide = mixed({a, b}, halves(), {.border = Border::soft, .width = 200, .wraps_x = true, .wraps_y = true});
  CHECK(at(wide, "roughness", 10) > 0.4f);  // wider than the material
  check_tiles_agree(*wide.material->find("roughness"));
}

TEST_CASE("mixes are the same in tiles, of every size, and of many materials") {
  const MaterialPtr a = noisy(1), b = noisy(50), c = noisy(80);
  const ImagePtr three = noise_image({9, 7}, 1, Semantic::mask, "raw", 5);
  for (const Border border : {Border::hard, Border::soft, Border::height}) {
    const Mix mix = mixed({a, b, c}, three, {.border = border, .width = 9, .offset = 0.2, .wraps_y = true});
    for (const Map& m : mix.material->maps()) check_tiles_agree(*m.image);
    check_tiles_agree(*mix.labels);
    for (const float label : mix.labels->pixels()) CHECK((label == 0 || label == 0.5f || label == 1));
    CHECK(mix.parts[0] + mix.parts[1] + mix.parts[2] == doctest::Approx(1));
  }
}

TEST_CASE("maps may be smaller in one of the materials") {
  const auto with_roughness = [](Size of, float value) {
    return Material::make("m", {{"height", flat_image(size, {value}, Semantic::height)},
                                {"roughness", flat_image(of, {value}, Semantic::roughness)}});
  };
  const Mix mix = mixed({with_roughness({20, 12}, 0.25f), with_roughness(size, 0.5f)}, halves(), {});
  CHECK(mix.material->find("roughness")->size() == size);
  const Mix both = mixed({with_roughness({20, 12}, 0.25f), with_roughness({10, 6}, 0.5f)}, halves(),
                         {.border = Border::height, .width = 8});
  CHECK(both.material->find("roughness")->size() == Size{20, 12});
  CHECK(both.material->find("roughness")->read({4, 6, 1, 1}).front() == 0.25f);
  CHECK(both.material->find("roughness")->read({16, 6, 1, 1}).front() == 0.5f);
}

TEST_CASE("what cannot be mixed is refused with what to do") {
  const auto material = [](const Size& of, const char* map, Semantic semantic, int channels = 1) {
    return Material::make("m", {{map, flat_image(of, std::vector<float>(size_t(channels), 0.5f), semantic)}});
  };
  const MaterialPtr a = material(size, "roughness", Semantic::roughness);
  CHECK_THROWS_WITH_AS(mixed({a, material({20, 24}, "roughness", Semantic::roughness)}, halves(), {}),
                       doctest::Contains("the first has 40x24 pixels, another 20x24"), Error);
  CHECK_THROWS_WITH_AS(mixed({a, material(size, "height", Semantic::height)}, halves(), {}),
                       doctest::Contains("expected the same maps in all materials"), Error);
  CHECK_THROWS_WITH_AS(mixed({a, a}, halves(), {.border = Border::height}),
                       doctest::Contains("has only roughness; add one, such as \"make_height\" makes"), Error);
  CHECK_THROWS_WITH_AS(mixed({a, a}, flat_image(size, {1, 1, 1}), {}), doctest::Contains("1 channel"), Error);
  const MaterialPtr vectors = material(size, "height", Semantic::height, 3);
  CHECK_THROWS_WITH_AS(mixed({vectors, vectors}, halves(), {.border = Border::height}),
                       doctest::Contains("height maps of 1 channel, found a height map"), Error);
}

TEST_CASE("hostile maps and heights do no harm") {
  const float nan = std::nanf("");
  const MaterialPtr holes = Material::make(
      "h", {{"height", make_image(
                           size, 1, [&](int x, int, int) { return x % 3 ? 0.5f : nan; }, Semantic::height)},
            {"roughness", flat_image(size, {0.5f}, Semantic::roughness)}});
  const MaterialPtr flat = constant(0.5f, 0.5f, 0.5f, {0, 0, 1});
  const ImagePtr odd = make_image(size, 1, [&](int x, int, int) { return x < 10 ? nan : x < 20 ? -5.f : 1e30f; });
  const Mix mix = mixed({holes, holes}, odd, {.border = Border::height, .width = 12, .softness = 0});
  for (const float v : mix.material->find("roughness")->pixels()) CHECK(v == 0.5f);
  CHECK(mix.parts == std::vector<double>{0.5, 0.5});
  // Equal heights everywhere: the border stays where the map has it.
  const Mix equal =
      mixed({flat, constant(0.5f, 0.5f, 1, {0, 0, 1})}, halves(), {.border = Border::height, .width = 12});
  CHECK(at(equal, "roughness", 14) == 0.5f);
  CHECK(at(equal, "roughness", 25) == 1);
}

TEST_CASE("values of a mix map stand for the nearest material") {
  CHECK(material_at(0.5f, 2) == 0);
  CHECK(material_at(0.51f, 2) == 1);
  CHECK(material_at(0.5f, 3) == 1);
  CHECK(material_at(0.2f, 3) == 0);
  CHECK(material_at(7, 3) == 2);
  CHECK(material_at(-7, 3) == 0);
  CHECK(material_at(0.7f, 1) == 0);
}
