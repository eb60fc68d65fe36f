#include "core/filter/slow_light.h"

#include <cmath>
#include <functional>
#include <vector>

#include <doctest/doctest.h>

#include "core/base/hash.h"

using namespace terrazzo;

namespace {

constexpr Size lit_size{160, 128};

/// Numbers from -1 to 1.
double lit_noise(int x, int y, unsigned seed = 1) {
  return double(random_bits(seed, uint64_t(x), uint64_t(y), 0) % 2001) / 1000 - 1;
}

/// Stones of 16 pixels, each of its own tone.
double lit_stones(int x, int y) {
  return 0.2 * (1 + 0.5 * lit_noise(x / 16, y / 16, 2)) * (1 + 0.2 * lit_noise(x, y));
}

ImagePtr lit_grey(const std::function<double(int, int)>& value, Size size = lit_size) {
  std::vector<float> pixels;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++)
      for (int c = 0; c < 3; c++) pixels.push_back(float(value(x, y)));
  return Image::from_floats(
      {.size = size, .channels = 3, .semantic = Semantic::base_color, .color_space = "lin_rec709"}, std::move(pixels));
}

double light_at(const SlowLight& light, int x, int y) {
  double out = 0;
  light.logarithms(x, y, 1, &out);
  return out;
}

}  // namespace

TEST_CASE("a slope and a vignette are found through the tones of stones, and nothing where there is none") {
  const auto slope = [](int x, int) { return std::exp(0.8 * (x / 160.0 - 0.5)); };
  const SlowLight across(lit_grey([&](int x, int y) { return lit_stones(x, y) * slope(x, y); }), nullptr, 2, false);
  REQUIRE(across.is_any());
  CHECK(light_at(across, 150, 60) - light_at(across, 10, 60) == doctest::Approx(0.7).epsilon(0.25));
  CHECK(across.contrast() > 1.6);

  const auto vignette = [](int x, int y) {
    const double u = (x - 80) / 80.0, v = (y - 64) / 64.0;
    return 1 - 0.3 * (u * u + v * v);
  };
  const SlowLight dark(lit_grey([&](int x, int y) { return lit_stones(x, y) * vignette(x, y); }), nullptr, 2, false);
  REQUIRE(dark.is_any());
  CHECK(light_at(dark, 80, 64) - light_at(dark, 2, 2) > 0.5);

  const SlowLight none(lit_grey(lit_stones), nullptr, 2, false);
  CHECK_FALSE(none.is_any());
  CHECK(none.contrast() == 1);
  CHECK(light_at(none, 3, 3) == 0);
  CHECK_FALSE(SlowLight(lit_grey([](int, int) { return 0.4; }), nullptr, 4, false).is_any());
  CHECK_FALSE(SlowLight(lit_grey(slope, {160, 31}), nullptr, 2, false).is_any());
}

TEST_CASE("a slope of pure light is found exactly, with a mean logarithm of 0") {
  const SlowLight light(lit_grey([](int x, int y) { return 0.5 * std::exp(0.6 * (x / 160.0) - 0.3 * (y / 128.0)); }),
                        nullptr, 1, false);
  CHECK(light_at(light, 159, 0) - light_at(light, 0, 0) == doctest::Approx(0.6 * 159 / 160).epsilon(0.01));
  CHECK(light_at(light, 0, 127) - light_at(light, 0, 0) == doctest::Approx(-0.3 * 127 / 128).epsilon(0.01));
  double sum = 0;
  for (int y = 0; y < lit_size.height; y++)
    for (int x = 0; x < lit_size.width; x++) sum += light_at(light, x, y);
  CHECK(std::abs(sum) / double(lit_size.area()) < 1e-9);
}

TEST_CASE("a change of colour is no light, and unlike slabs rarely pass for it") {
  const ImagePtr mossy = lit_grey([](int, int) { return 1.0; });
  std::vector<float> pixels = mossy->pixels();
  for (int y = 0; y < lit_size.height; y++)
    for (int x = 0; x < lit_size.width; x++) {
      const double moss = x / 160.0;  // stone on the left, green on the right
      float* p = &pixels[size_t(y * lit_size.width + x) * 3];
      const double tone = lit_stones(x, y);
      p[0] = float(tone * (1 - 0.7 * moss));
      p[1] = float(tone * (1 - 0.3 * moss));
      p[2] = float(tone * (1 - 0.8 * moss));
    }
  CHECK_FALSE(SlowLight(Image::from_floats(mossy->info(), std::move(pixels)), nullptr, 2, false).is_any());
  int found = 0;
  for (unsigned seed = 1; seed <= 20; seed++) {
    const auto slabs = [&](int x, int y) { return 0.15 + 0.3 * std::abs(lit_noise(x / 20, y / 20, seed)); };
    found += SlowLight(lit_grey(slabs), nullptr, 2, false).is_any();
  }
  CHECK(found <= 4);  // one in twenty by chance
}

TEST_CASE("light of a picture that wraps, wraps") {
  const auto wave = [](int x, int y) { return lit_stones(x, y) * std::exp(0.4 * std::cos(6.283185307 * x / 160)); };
  const SlowLight light(lit_grey(wave), nullptr, 2, true);
  REQUIRE(light.is_any());
  CHECK(light_at(light, 0, 64) - light_at(light, 80, 64) == doctest::Approx(0.8).epsilon(0.25));
  CHECK(light_at(light, 159, 64) == doctest::Approx(light_at(light, 0, 64)).epsilon(0.05));
}

TEST_CASE("what is masked out does not count") {
  std::vector<float> visible;
  for (int y = 0; y < lit_size.height; y++)
    for (int x = 0; x < lit_size.width; x++) visible.push_back(x < 120 ? 1 : 0);
  const ImagePtr opacity =
      Image::from_floats({.size = lit_size, .channels = 1, .semantic = Semantic::opacity}, std::move(visible));
  const ImagePtr backed = lit_grey([](int x, int y) { return x < 120 ? lit_stones(x, y) : 0.0; });
  CHECK(SlowLight(backed, nullptr, 2, false).is_any());
  CHECK_FALSE(SlowLight(backed, opacity, 2, false).is_any());
}
