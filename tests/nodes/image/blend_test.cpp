#include <cmath>

#include <doctest/doctest.h>

#include "core/image/normal.h"
#include "core/image/srgb.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

float blended(const std::string& mode, float base, float top, const Params& more = {}) {
  Params params = more;
  params["mode"] = mode;
  return run_image("blend", params, {{"base", flat_image({2, 2}, {base})}, {"top", flat_image({2, 2}, {top})}})
      ->pixels()
      .front();
}

ImagePtr normal_image(Size size, const Vector3f& direction, NormalY normal_y = NormalY::up) {
  std::vector<float> pixel(3);
  encode_normal(normalized(direction), normal_y, pixel.data());
  ImageInfo info{.size = size, .channels = 3, .semantic = Semantic::normal, .normal_y = normal_y};
  return Image::redescribed(flat_image(size, pixel, Semantic::normal), info);
}

}  // namespace

TEST_CASE("blend modes give what paint programs give") {
  CHECK(blended("auto", 0.4f, 0.9f) == doctest::Approx(0.9));
  CHECK(blended("normal", 0.4f, 0.9f, {{"opacity", 0.5}}) == doctest::Approx(0.65));
  CHECK(blended("multiply", 0.4f, 0.5f) == doctest::Approx(0.2));
  CHECK(blended("screen", 0.4f, 0.5f) == doctest::Approx(0.7));
  CHECK(blended("overlay", 0.25f, 0.5f) == doctest::Approx(0.25));
  CHECK(blended("overlay", 0.75f, 0.9f) == doctest::Approx(0.95));
  CHECK(blended("add", 0.4f, 0.5f) == doctest::Approx(0.9));
  CHECK(blended("subtract", 0.4f, 0.5f) == doctest::Approx(-0.1));
  CHECK(blended("difference", 0.4f, 0.5f) == doctest::Approx(0.1));
  CHECK(blended("min", 0.4f, 0.5f) == doctest::Approx(0.4));
  CHECK(blended("max", 0.4f, 0.5f) == doctest::Approx(0.5));
}

TEST_CASE("the mask says where the top shows, and one channel serves all") {
  const ImagePtr base = flat_image({3, 1}, {0.2f, 0.4f, 0.6f});
  const ImagePtr mask = make_image(
      {3, 1}, 1, [](int x, int, int) { return float(x) / 2; }, Semantic::mask);
  const std::vector<float> p =
      run_image("blend", {}, {{"base", base}, {"top", flat_image({3, 1}, {1})}, {"mask", mask}})->pixels();
  const std::vector<double> expected = {0.2, 0.4, 0.6, 0.6, 0.7, 0.8, 1, 1, 1};
  for (size_t i = 0; i < p.size(); i++) CHECK(p[i] == doctest::Approx(expected[i]));
}

TEST_CASE("colours are mixed in linear light unless told otherwise") {
  const ImagePtr black = flat_image({1, 1}, {0, 0, 0}, Semantic::base_color, "srgb_texture");
  const ImagePtr white = flat_image({1, 1}, {1, 1, 1}, Semantic::base_color, "srgb_texture");
  const auto mixed = [&](bool linear) {
    return run_image("blend", {{"opacity", 0.5}, {"linear", linear}}, {{"base", black}, {"top", white}})
        ->pixels()
        .front();
  };
  CHECK(mixed(true) == doctest::Approx(encode_srgb(0.5f)));
  CHECK(mixed(false) == doctest::Approx(0.5));
}

TEST_CASE("8-bit results stay within the file's range") {
  const ImagePtr light = with_depth(flat_image({1, 1}, {0.8f}), Depth::u8);
  CHECK(run_image("blend", {{"mode", "add"}}, {{"base", light}, {"top", light}})->pixels().front() == 1);
}

TEST_CASE("a flat detail leaves a normal map, and on a flat base the detail is what shows") {
  const ImagePtr flat = normal_image({2, 2}, {0, 0, 1}), leaning = normal_image({2, 2}, {0.3f, -0.5f, 0.8f});
  CHECK(greatest_difference(*run_image("blend", {}, {{"base", leaning}, {"top", flat}}), *leaning) < 1e-6);
  CHECK(greatest_difference(*run_image("blend", {}, {{"base", flat}, {"top", leaning}}), *leaning) < 1e-6);
  CHECK(greatest_difference(*run_image("blend", {{"opacity", 0.0}}, {{"base", leaning}, {"top", leaning}}), *leaning) <
        1e-6);
}

TEST_CASE("detail adds up: two slopes laid over each other lean by the sum of their angles") {
  const auto lean = [](double angle) { return Vector3f{float(std::sin(angle)), 0, float(std::cos(angle))}; };
  const ImagePtr both =
      run_image("blend", {{"mode", "detail"}},
                {{"base", normal_image({1, 1}, lean(0.3))}, {"top", normal_image({1, 1}, lean(0.4))}});
  CHECK(greatest_difference(*both, *normal_image({1, 1}, lean(0.7))) < 1e-6);
}

TEST_CASE("normals of the other convention are read as what they are") {
  const Vector3f up = {0, 0.6f, 0.8f};
  const ImagePtr result = run_image(
      "blend", {},
      {{"base", normal_image({1, 1}, {0, 0, 1}, NormalY::down)}, {"top", normal_image({1, 1}, up, NormalY::up)}});
  CHECK(result->info().normal_y == NormalY::down);
  CHECK(greatest_difference(*result, *normal_image({1, 1}, up, NormalY::down)) < 1e-6);
}

TEST_CASE("blend is the same in tiles and as a whole") {
  for (const Semantic semantic : {Semantic::base_color, Semantic::normal})
    check_every_size([&](Size size) {
      const std::string space = semantic == Semantic::base_color ? "srgb_texture" : "raw";
      return run_image("blend", {},
                       {{"base", noise_image(size, 3, semantic, space)},
                        {"top", noise_image(size, 3, semantic, space, 2)},
                        {"mask", noise_image(size, 1, Semantic::mask, "raw", 3)}});
    });
}

TEST_CASE("blend states what does not fit together") {
  const ImagePtr one = flat_image({2, 2}, {0}), three = flat_image({2, 2}, {0, 0, 0});
  const ImagePtr normals = normal_image({2, 2}, {0, 0, 1});
  CHECK(error_of("blend", {}, {{"base", one}, {"top", flat_image({3, 2}, {0})}}, "top").find("2x2, found 3x2") !=
        std::string::npos);
  CHECK(error_of("blend", {}, {{"base", one}, {"top", three}}, "top").find("1 channel or as many") !=
        std::string::npos);
  CHECK(error_of("blend", {}, {{"base", one}, {"top", one}, {"mask", three}}, "mask").find("3 channels") !=
        std::string::npos);
  CHECK(error_of("blend", {}, {{"base", normals}, {"top", three}}, "top").find("normals over normals") !=
        std::string::npos);
  CHECK(error_of("blend", {{"mode", "add"}}, {{"base", normals}, {"top", normals}}, "mode").find("found add") !=
        std::string::npos);
  CHECK(error_of("blend", {{"mode", "detail"}}, {{"base", one}, {"top", one}}, "mode").find("for normal maps") !=
        std::string::npos);
  CHECK(error_of("blend", {},
                 {{"base", flat_image({1, 1}, {0}, Semantic::base_color, "srgb_texture")},
                  {"top", flat_image({1, 1}, {0}, Semantic::base_color, "acescg")}},
                 "top")
            .find("srgb_texture, or raw; found acescg") != std::string::npos);
}
