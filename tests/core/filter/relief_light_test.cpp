#include "core/filter/relief_light.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <doctest/doctest.h>

#include "core/base/hash.h"
#include "core/image/normal.h"

using namespace terrazzo;

namespace {

constexpr Size relief_size{128, 128};

struct LitRelief {
  ImagePtr color, normals, heights;
};

/// Bumps, and a surface whose tone is `tone` times the light from the right and above, as strong as given.
LitRelief lit_relief(double strength, const std::function<double(int, int)>& tone) {
  std::vector<float> color, normals, heights;
  for (int y = 0; y < relief_size.height; y++)
    for (int x = 0; x < relief_size.width; x++) {
      const double u = x * 0.39269908169872414, v = y * 0.39269908169872414;  // 16 pixels a bump
      heights.push_back(float(0.5 + 0.5 * std::sin(u) * std::sin(v)));
      const Vector3f n =
          normalized(Vector3f(float(-0.6 * std::cos(u) * std::sin(v)), float(0.6 * std::sin(u) * std::cos(v)), 1.0f));
      float encoded[3];
      encode_normal(n, NormalY::up, encoded);
      normals.insert(normals.end(), encoded, encoded + 3);
      const double light = std::max(0.25, 1 + strength * (0.8 * double(n.x()) + 0.6 * double(n.y())));
      for (int c = 0; c < 3; c++) color.push_back(float(0.3 * tone(x, y) * light));
    }
  return {Image::from_floats(
              {.size = relief_size, .channels = 3, .semantic = Semantic::base_color, .color_space = "lin_rec709"},
              std::move(color)),
          Image::from_floats({.size = relief_size, .channels = 3, .semantic = Semantic::normal}, std::move(normals)),
          Image::from_floats({.size = relief_size, .channels = 1, .semantic = Semantic::height}, std::move(heights))};
}

double grain(int x, int y) {
  return 0.8 + 0.4 * double(random_bits(3, uint64_t(x), uint64_t(y), 0) % 1000) / 1000;
}

ReliefLight found_in(const LitRelief& s) {
  return relief_light(s.color, nullptr, s.normals, SlowLight(), Task());
}

}  // namespace

TEST_CASE("the direction and strength of light on a relief are found from its normals") {
  const ReliefLight light = found_in(lit_relief(1.2, grain));
  REQUIRE(light.is_any());
  CHECK(light.x == doctest::Approx(0.96).epsilon(0.03));
  CHECK(light.y == doctest::Approx(0.72).epsilon(0.03));
  CHECK(light.azimuth() == doctest::Approx(36.9).epsilon(0.03));
  CHECK(light.explained > 0.5);
  CHECK(light.shading(0, 0) == 1);
  CHECK(light.shading(-1, 0) == 0.25);
}

TEST_CASE("heights do for normals, whatever their scale") {
  const LitRelief s = lit_relief(1.2, grain);
  const ImagePtr normals = normals_of_usual_slope(s.heights, Outside::clamp);
  const ReliefLight light = relief_light(s.color, nullptr, normals, SlowLight(), Task());
  REQUIRE(light.is_any());
  CHECK(light.azimuth() == doctest::Approx(36.9).epsilon(0.05));
}

TEST_CASE("tones that know no direction are no light on the relief") {
  CHECK_FALSE(found_in(lit_relief(0, grain)).is_any());
  const auto dirt = [](int x, int y) {
    return 1 + 0.4 * std::sin(x * 0.39269908169872414) * std::sin(y * 0.39269908169872414);
  };
  CHECK_FALSE(found_in(lit_relief(0, dirt)).is_any());
  LitRelief flat = lit_relief(1, grain);
  flat.normals = Image::from_floats({.size = relief_size, .channels = 3, .semantic = Semantic::normal},
                                    std::vector<float>(size_t(relief_size.area()) * 3, 0.5f));
  CHECK_FALSE(found_in(flat).is_any());
}

TEST_CASE("light that one part of the picture shows and another does not is none") {
  const LitRelief left = lit_relief(1, grain), right = lit_relief(-1, grain);
  std::vector<float> mixed = left.color->pixels();
  const std::vector<float> other = right.color->pixels();
  for (size_t i = 0; i < mixed.size(); i++)
    if (int(i / 3) % relief_size.width >= 58) mixed[i] = other[i];
  CHECK_FALSE(found_in({Image::from_floats(left.color->info(), std::move(mixed)), left.normals, nullptr}).is_any());
}
