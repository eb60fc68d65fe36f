#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// Speckle that grows lighter from left to right.
ImagePtr drying(Size size) {
  return make_image(size, 1, [&](int x, int y, int) {
    return float(0.2 + 0.4 * x / size.width + 0.3 * unit_double(random_bits(2, x, y)));
  });
}

std::vector<float> progression(const ImagePtr& image, const Params& params) {
  const NodeRun run = run_node("progression", params, {{"material", {image}}});
  const ImagePtr out = run.get<Image>("progression");
  CHECK(out->size() == image->size());
  CHECK(out->info().semantic == Semantic::guidance);
  return out->pixels();
}

const Params untiled{{"tiles", std::string("no")}, {"radius", 0.15}};

}  // namespace

TEST_CASE("progression finds the change beneath the speckle and spreads it evenly over 0..1") {
  const Size size{64, 48};
  const std::vector<float> p = progression(drying(size), untiled);
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++)
      REQUIRE(double(p[size_t(y * size.width + x)]) == doctest::Approx((x + 0.5) / size.width).epsilon(0.09));
  std::vector<float> sorted = p;
  std::sort(sorted.begin(), sorted.end());
  CHECK(sorted.front() == 0);
  CHECK(sorted.back() == 1);
  for (const double part : {0.25, 0.5, 0.75})
    CHECK(double(sorted[size_t(part * double(sorted.size()))]) == doctest::Approx(part).epsilon(0.01));
}

TEST_CASE("progression is inverted on request and flat where nothing varies") {
  const ImagePtr image = drying({32, 32});
  Params inverted = untiled;
  inverted["inverted"] = true;
  const std::vector<float> p = progression(image, untiled), q = progression(image, inverted);
  for (size_t i = 0; i < p.size(); i++) REQUIRE(p[i] + q[i] == doctest::Approx(1));
  for (const float v : progression(flat_image({20, 20}, {0.3f}), untiled)) CHECK(v == 0.5f);
}

TEST_CASE("progression looks at colour too, and only at the maps it is told to") {
  // Red fades into a green of the same lightness; roughness goes down the image.
  const ImagePtr color = make_image(
      {48, 48}, 3,
      [](int x, int y, int c) {
        const float speckle = 0.1f * float(unit_double(random_bits(4, x, y)));
        return (c == 0 ? 0.7f - 0.009f * float(x) : c == 1 ? 0.3f + 0.0042f * float(x) : 0.2f) + speckle;
      },
      Semantic::base_color, "srgb_texture");
  const ImagePtr rough = make_image(
      {48, 48}, 1, [](int, int y, int) { return float(y) / 48; }, Semantic::roughness);
  const MaterialPtr material = Material::make("m", {{"base_color", color}, {"roughness", rough}});
  const auto along = [&](const std::string& map) {
    Params params = untiled;
    params["maps"] = Texts{map};
    const std::vector<float> p =
        run_node("progression", params, {{"material", {material}}}).get<Image>("progression")->pixels();
    return std::array{std::fabs(p[24 * 48 + 43] - p[24 * 48 + 4]), std::fabs(p[43 * 48 + 24] - p[4 * 48 + 24])};
  };
  CHECK(along("base_color")[0] > 0.7f);
  CHECK(along("base_color")[1] < 0.2f);
  CHECK(along("roughness")[1] > 0.7f);
  CHECK(along("roughness")[0] < 0.01f);
  CHECK_THROWS_WITH_AS(run_node("progression", {{"maps", Texts{"moisture"}}}, {{"material", {material}}}),
                       "there is no map \"moisture\"; the material has base_color, roughness", Error);
}

TEST_CASE("progression is the same at every size on any number of threads") {
  check_every_size([](Size size) {
    return run_node("progression", untiled, {{"material", {noise_image(size, 1)}}}).get<Image>("progression");
  });
}
