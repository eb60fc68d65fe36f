#include <cmath>

#include <doctest/doctest.h>

#include "nodes/common/registry.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

ImagePtr preview(const MaterialPtr& material, const Params& params) {
  return run_node("preview", params, {{"material", {material}}}).get<Image>("image");
}

ImagePtr white(Size size) {
  return make_image(
      size, 3, [](int, int, int) { return 0.8f; }, Semantic::base_color, "srgb_texture");
}

ImagePtr with_convention(const ImagePtr& image, NormalY y) {
  ImageInfo info = image->info();
  info.normal_y = y;
  return Image::redescribed(image, info);
}

/// A round bump in the middle of a 32x32 map.
float bump(int x, int y) {
  const double r = std::hypot(x - 15.5, y - 15.5) / 12;
  return r < 1 ? float((1 - r * r) * (1 - r * r)) : 0.f;
}

ImagePtr bump_height() {
  return make_image(
      {32, 32}, 1, [](int x, int y, int) { return bump(x, y); }, Semantic::height);
}

/// The bump's normals, `sign` = 1 for green up.
ImagePtr bump_normals(int sign) {
  return make_image(
      {32, 32}, 3,
      [sign](int x, int y, int c) {
        const double nx = (bump(x - 1, y) - bump(x + 1, y)) * 3, ny = (bump(x, y + 1) - bump(x, y - 1)) * 3 * sign;
        const double n[3] = {nx, ny, 1};
        return float(n[c] / std::sqrt(nx * nx + ny * ny + 1) * 0.5 + 0.5);
      },
      Semantic::normal);
}

/// Brightness at a pixel.
double at(const ImagePtr& image, int x, int y) {
  float p[3];
  image->read({x, y, 1, 1}, p);
  return p[0] + p[1] + p[2];
}

}  // namespace

TEST_CASE("a flat surface lit from the front is evenly bright, and tinted as its colour") {
  const ImagePtr picture = preview(Material::of(white({20, 20})), {{"size", Size{24, 16}}, {"elevation", 90.0}});
  CHECK(picture->size() == Size{24, 16});
  CHECK(picture->info().color_space == "srgb_texture");
  CHECK(picture->info().semantic == Semantic::base_color);
  const std::vector<float> p = picture->pixels();
  for (const float v : p) CHECK(v == p[0]);
  CHECK(p[0] > 0.7);

  const ImagePtr red = make_image(
      {8, 8}, 3, [](int, int, int c) { return c == 0 ? 0.6f : 0.2f; }, Semantic::base_color, "srgb_texture");
  const std::vector<float> r = preview(Material::of(red), {{"size", Size{8, 8}}})->pixels();
  CHECK(r[0] > r[1] + 0.2f);
}

TEST_CASE("slopes that face the light are bright, whether they come from normals or from height") {
  for (const ImagePtr& map : {bump_normals(1), bump_height()}) {
    const auto lit = [&](double azimuth) {
      return preview(Material::make("bump", {{"base_color", white({32, 32})}, {"shape", map}}),
                     {{"size", Size{32, 32}}, {"azimuth", azimuth}});
    };
    const ImagePtr right = lit(0), above = lit(90), left = lit(180), below = lit(270);
    CHECK(at(right, 22, 16) > at(right, 9, 16) + 0.1);
    CHECK(at(left, 22, 16) < at(left, 9, 16) - 0.1);
    CHECK(at(above, 16, 9) > at(above, 16, 22) + 0.1);
    CHECK(at(below, 16, 9) < at(below, 16, 22) - 0.1);
  }
}

TEST_CASE("both conventions of the same normals render alike") {
  const auto lit = [](const ImagePtr& normals) {
    return preview(Material::make("bump", {{"normal", normals}}), {{"size", Size{32, 32}}})->digest();
  };
  CHECK(lit(bump_normals(1)) == lit(with_convention(bump_normals(-1), NormalY::down)));
  CHECK(lit(bump_normals(1)) != lit(bump_normals(-1)));
}

TEST_CASE("a step throws a shadow away from the light, as long as the relief is deep") {
  const auto height = make_image(
      {64, 16}, 1, [](int x, int, int) { return x > 20 && x < 40 ? 1.f : 0.f; }, Semantic::height);
  const MaterialPtr m = Material::make("step", {{"base_color", white({64, 16})}, {"height", height}});
  const auto lit = [&](double relief) {
    return preview(m, {{"size", Size{64, 16}}, {"azimuth", 180.0}, {"elevation", 30.0}, {"relief", relief}});
  };
  const ImagePtr shallow = lit(0.2), deep = lit(1);
  CHECK(at(deep, 43, 8) < at(deep, 15, 8) - 0.5);
  CHECK(at(deep, 58, 8) == doctest::Approx(at(deep, 10, 8)).epsilon(0.01));
  CHECK(at(shallow, 42, 8) > at(deep, 42, 8) + 0.3);
}

TEST_CASE("heights that do not tile put no cliff on the border, with normals or without, once or repeated") {
  // A slope that rises to the right by more than any step inside: across the border it falls back.
  const auto slope = [](int side) {
    return make_image(
        {side, 32}, 1, [=](int x, int, int) { return float(x) / float(side); }, Semantic::height);
  };
  const auto lit = [](const ImagePtr& height, double repeats, bool with_normals) {
    std::vector<Map> maps = {{"base_color", white(height->size())}, {"height", height}};
    if (with_normals)
      maps.push_back(
          {"normal", run_node("make_normal", {{"edges", "clamp"}}, {{"height", {height}}}).get<Image>("normal")});
    return preview(
        Material::make("slope", maps),
        {{"size", Size{64, 32}}, {"azimuth", 180.0}, {"elevation", 20.0}, {"relief", 4.0}, {"repeats", repeats}});
  };
  for (const bool with_normals : {false, true}) {
    CAPTURE(with_normals);
    const ImagePtr once = lit(slope(64), 1, with_normals), twice = lit(slope(32), 2, with_normals);
    for (int x = 1; x < 63; x++) CHECK(at(once, x, 16) == doctest::Approx(at(once, 32, 16)).epsilon(0.02));
    for (const int x : {2, 10, 29, 34, 50, 61})
      CHECK(at(twice, x, 16) == doctest::Approx(at(twice, 16, 16)).epsilon(0.02));
  }
  // A wall that tiles throws its shadow across the border.
  const auto wall = make_image(
      {64, 32}, 1, [](int x, int, int) { return x < 8 || x >= 40 ? 1.f : 0.f; }, Semantic::height);
  const auto across = make_image(
      {64, 32}, 1, [](int x, int, int) { return x >= 56 ? 1.f : 0.f; }, Semantic::height);
  CHECK(at(lit(wall, 1, false), 9, 16) < at(lit(wall, 1, false), 30, 16) - 0.5);
  CHECK(at(lit(across, 1, false), 1, 16) < at(lit(across, 1, false), 40, 16) - 0.5);
}

TEST_CASE("rough and smooth, metal and not, occluded and open differ as they should") {
  const auto flat = [](Semantic semantic, float value) {
    return Map{std::string(name_of(semantic)), make_image(
                                                   {4, 4}, 1, [value](int, int, int) { return value; }, semantic)};
  };
  const auto brightness = [&](std::vector<Map> maps, double elevation) {
    maps.push_back({"base_color", white({4, 4})});
    return at(preview(Material::make("m", maps), {{"size", Size{4, 4}}, {"elevation", elevation}}), 2, 2);
  };
  CHECK(brightness({flat(Semantic::roughness, 0.15f)}, 90) > brightness({flat(Semantic::roughness, 1)}, 90));
  CHECK(brightness({flat(Semantic::metallic, 1), flat(Semantic::roughness, 0.2f)}, 30) <
        brightness({flat(Semantic::metallic, 0), flat(Semantic::roughness, 0.2f)}, 30));
  CHECK(brightness({flat(Semantic::ambient_occlusion, 0)}, 45) <
        brightness({flat(Semantic::ambient_occlusion, 1)}, 45));
  CHECK(brightness({flat(Semantic::emission, 0.5f)}, 0) > brightness({}, 0) + 0.2);
}

TEST_CASE("a ball stands before the background, lit from the light's side") {
  const ImagePtr ball = preview(
      Material::of(white({16, 16})),
      {{"shape", "sphere"}, {"size", Size{64, 48}}, {"azimuth", 180.0}, {"background", Numbers{0.2, 0.4, 0.6}}});
  float corner[3];
  ball->read({0, 0, 1, 1}, corner);
  CHECK(corner[0] == doctest::Approx(0.2));
  CHECK(corner[1] == doctest::Approx(0.4));
  CHECK(corner[2] == doctest::Approx(0.6));
  CHECK(at(ball, 20, 24) > at(ball, 44, 24) + 0.2);
  CHECK(at(ball, 32, 24) != doctest::Approx(1.2));
}

TEST_CASE("several lights make a sheet whose pictures are those of the single lights") {
  const MaterialPtr m = Material::make("bump", {{"normal", bump_normals(1)}, {"height", bump_height()}});
  const ImagePtr sheet = preview(m, {{"size", Size{32, 20}}, {"lights", Numbers{0, 90, 200}}});
  CHECK(sheet->size() == Size{6 + 32 + 6 + 32 + 6, 6 + 20 + 6 + 20 + 6});
  CHECK(sheet->read({44, 6, 32, 20}) == preview(m, {{"size", Size{32, 20}}, {"azimuth", 90.0}})->pixels());
  CHECK(sheet->read({6, 32, 32, 20}) == preview(m, {{"size", Size{32, 20}}, {"azimuth", 200.0}})->pixels());
}

TEST_CASE("maps of other sizes, odd shapes and tilted planes render") {
  const auto height = make_image(
      {5, 3}, 1, [](int x, int y, int) { return float(x + y) / 6; }, Semantic::height);
  const MaterialPtr m = Material::make("odd", {{"base_color", white({40, 10})}, {"height", height}});
  for (const std::string shape : {"plane", "sphere"})
    for (const Size size : {Size{16, 16}, Size{33, 7}, Size{1, 1}}) {
      const ImagePtr p = preview(m, {{"shape", shape}, {"size", size}, {"tilt", 50.0}, {"repeats", 2.5}});
      CHECK(p->size() == size);
      CHECK(p->digest() == preview(m, {{"shape", shape}, {"size", size}, {"tilt", 50.0}, {"repeats", 2.5}})->digest());
    }
}

TEST_CASE("a picture from above of another shape than the material is a note that names the size to show it whole") {
  const MaterialPtr material = Material::of(white({60, 40}));
  const auto notes = [&](const Params& params) {
    return run_node("preview", params, {{"material", {material}}}).notes;
  };
  const std::vector<std::string> square = notes({{"size", Size{30, 30}}});
  REQUIRE(square.size() == 1);
  CHECK(square.front() ==
        "the material (60x40) and the picture (30x30) differ in aspect ratio: the material fills the width once and "
        "the height 1.50 times; a size of 30x20 shows exactly one");
  CHECK(notes({{"size", Size{30, 10}}}).front().find("the height 0.50 times") != std::string::npos);
  CHECK(notes({{"size", Size{31, 20}}}).empty());
  CHECK(notes({{"size", Size{30, 30}}, {"repeats", 2.0}}).empty());
  CHECK(notes({{"size", Size{30, 30}}, {"tilt", 30.0}}).empty());
  CHECK(notes({{"size", Size{30, 30}}, {"shape", "sphere"}}).empty());
}

TEST_CASE("a side of 0 takes the proportions of the material, which is never stretched") {
  const ImagePtr halves = make_image(
      {60, 30}, 3, [](int x, int y, int) { return x < 30 && y < 15 ? 0.8f : 0.2f; }, Semantic::base_color,
      "srgb_texture");
  const auto lit = [&](Size size, const std::string& shape = "plane") {
    return preview(Material::of(halves), {{"size", size}, {"shape", shape}, {"elevation", 90.0}});
  };
  for (const ImagePtr& picture : {lit({40, 0}), lit({0, 20})}) {
    CHECK(picture->size() == Size{40, 20});
    CHECK(at(picture, 16, 6) > at(picture, 24, 6) + 0.3);
    CHECK(at(picture, 16, 6) > at(picture, 16, 14) + 0.3);
  }
  // Where the picture has other proportions, the material repeats.
  const ImagePtr square = lit({40, 40});
  CHECK(square->read({0, 0, 40, 20}) == square->read({0, 20, 40, 20}));
  CHECK(lit({0, 24}, "sphere")->size() == Size{24, 24});
  CHECK(run_node("preview", {{"size", Size{40, 0}}}, {{"material", {Material::of(halves)}}}).notes.empty());
  CHECK(find_node_type("preview")->check({{"size", Size{0, 0}}}).size() == 1);
}
