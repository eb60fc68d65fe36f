#include "core/stochastic/noise_by_example.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <doctest/doctest.h>
#include <tbb/global_control.h>

#include "core/base/error.h"
#include "core/image/distribution.h"
#include "core/image/normal.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// A bumpy surface without structure, the same at each pixel whatever it is asked for.
double bump(int which, int x, int y) {
  double sum = 0;
  for (int dy = -1; dy <= 1; dy++)
    for (int dx = -1; dx <= 1; dx++) sum += unit_double(random_bits(uint64_t(which), x + dx, y + dy));
  return sum / 9;
}

ImagePtr map_of(Size size, int channels, Semantic semantic, const std::function<float(int, int, int)>& value) {
  return make_image(size, channels, value, semantic);
}

ImagePtr heights(Size size) {
  return map_of(size, 1, Semantic::height, [](int x, int y, int) { return float(bump(1, x, y)); });
}

ImagePtr noise_of(const ImagePtr& map, const NoiseByExample& options) {
  return noise_by_example(*Material::of(map), options)->maps().front().image;
}

std::vector<float> sorted(std::vector<float> values) {
  std::ranges::sort(values);
  return values;
}

/// The largest distance between two maps' values of one rank, over the first one's range.
double histogram_distance(const Image& a, const Image& b) {
  const std::vector<float> p = sorted(a.pixels()), q = sorted(b.pixels());
  double largest = 0;
  for (int percent = 2; percent <= 98; percent++)
    largest = std::max(largest, std::abs(double(p[p.size() * percent / 100]) - q[q.size() * percent / 100]));
  return largest / (double(p.back()) - p.front());
}

}  // namespace

TEST_CASE("a part of the surface is that part of the whole to the bit, at any origin and however it is read") {
  const ImagePtr map = heights({48, 40});
  const ImagePtr all = noise_of(map, {.size = {150, 120}, .origin = {-70, -50}, .cell = 9});
  const ImagePtr part = noise_of(map, {.size = {30, 20}, .origin = {40, 33}, .cell = 9});
  CHECK(part->pixels() == all->read({110, 83, 30, 20}));
  CHECK(part->read({7, 5, 3, 9}) == all->read({117, 88, 3, 9}));
  const ImagePtr far = noise_of(map, {.size = {40, 30}, .origin = {-1000000000, 1000000000}, .cell = 9});
  CHECK(far->pixels() ==
        noise_of(map, {.size = {60, 30}, .origin = {-1000000020, 1000000000}, .cell = 9})->read({20, 0, 40, 30}));
  CHECK(histogram_distance(*all, *far) < 0.25);
}

TEST_CASE("one thread gives the bytes of many") {
  const ImagePtr map = heights({64, 50});
  const NoiseByExample options{.size = {90, 70}, .cell = 12, .exemplar_tiles = true};
  const std::vector<float> many = noise_of(map, options)->pixels();
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  CHECK(noise_of(map, options)->pixels() == many);
}

TEST_CASE("it wraps where it is to, after a size that no cell fits") {
  const ImagePtr map = heights({48, 48});
  const NoiseByExample once{.size = {67, 53}, .surface = {{67, 53}, true, true}, .cell = 11};
  NoiseByExample twice = once;
  twice.size = {134, 106};
  const ImagePtr one = noise_of(map, once), four = noise_of(map, twice);
  for (const Rect& r : {Rect{0, 0, 67, 53}, Rect{67, 0, 67, 53}, Rect{0, 53, 67, 53}, Rect{67, 53, 67, 53}})
    CHECK(four->read(r) == one->pixels());
}

TEST_CASE("other seeds give other surfaces of the same histogram, and none is the exemplar's") {
  const ImagePtr map = heights({96, 96});
  const ImagePtr first = noise_of(map, {.size = {200, 200}, .cell = 24, .seed = 1});
  const ImagePtr second = noise_of(map, {.size = {200, 200}, .cell = 24, .seed = 2});
  CHECK(first->pixels() != second->pixels());
  CHECK(first->digest() != second->digest());
  for (const ImagePtr& made : {first, second}) CHECK(histogram_distance(*map, *made) < 0.05);
}

TEST_CASE("a skewed histogram comes back, and so does one of two values with its hard edges") {
  const ImagePtr skewed =
      map_of({96, 96}, 1, Semantic::roughness, [](int x, int y, int) { return float(std::pow(bump(2, x, y), 8)); });
  CHECK(histogram_distance(*skewed, *noise_of(skewed, {.size = {256, 256}, .cell = 20, .exemplar_tiles = true})) <
        0.05);
  const ImagePtr hard =
      map_of({96, 96}, 1, Semantic::metallic, [](int x, int y, int) { return bump(3, x, y) > 0.6 ? 1.0f : 0.0f; });
  double wanted = 0, found = 0;
  for (const float v : hard->pixels()) wanted += v;
  int between = 0;
  for (const float v : noise_of(hard, {.size = {256, 256}, .cell = 20, .exemplar_tiles = true})->pixels()) {
    found += v;
    between += v != 0 && v != 1;
  }
  CHECK(found / (256 * 256) == doctest::Approx(wanted / (96 * 96)).epsilon(0.1));
  CHECK(between < 256 * 256 / 50);
}

TEST_CASE("all maps stay in agreement: what determines one another in the exemplar does so in the result") {
  const Size size{96, 96};
  const MaterialPtr exemplar = Material::make(
      "soil", {{"base_color", map_of(size, 3, Semantic::base_color,
                                     [](int x, int y, int c) { return float(bump(1, x, y)) * (1 - 0.3f * float(c)); })},
               {"height", heights(size)},
               {"roughness",
                map_of(size, 1, Semantic::roughness, [](int x, int y, int) { return 1 - float(bump(1, x, y)); })}});
  const MaterialPtr made = noise_by_example(*exemplar, {.size = {120, 120}, .cell = 24});
  const std::vector<float> color = made->find("base_color")->pixels(), height = made->find("height")->pixels(),
                           rough = made->find("roughness")->pixels();
  for (size_t i = 0; i < height.size(); i++) {
    REQUIRE(std::abs(color[3 * i] - height[i]) < 0.02f);
    REQUIRE(std::abs(color[3 * i + 2] - 0.4f * height[i]) < 0.02f);
    REQUIRE(std::abs(rough[i] - (1 - height[i])) < 0.02f);
  }
}

TEST_CASE("normals have the exemplar's lengths and tilts, and fit whichever way y points") {
  const auto tilted = [](double size) {
    return map_of({64, 64}, 3, Semantic::normal, [size](int x, int y, int c) {
      Vector3f n(float(bump(4, x, y)) - 0.5f, float(bump(5, x, y)) - 0.5f, 1);
      n = normalized(n) * float(size);
      std::array<float, 3> out{};
      encode_normal(n, NormalY::up, out.data());
      return out[size_t(c)];
    });
  };
  for (const double size : {1.0, 0.8}) {
    const ImagePtr exemplar = tilted(size);
    const std::vector<float> made = noise_of(exemplar, {.size = {80, 80}, .cell = 15})->pixels();
    double tilt = 0;
    for (size_t i = 0; i < made.size(); i += 3) {
      const Vector3f n = decode_normal(&made[i], NormalY::up);
      REQUIRE(length(n) == doctest::Approx(size).epsilon(0.001));
      REQUIRE(n.z() > 0);
      tilt += std::abs(double(n.x()));
    }
    double wanted = 0;
    const std::vector<float> of = exemplar->pixels();
    for (size_t i = 0; i < of.size(); i += 3) wanted += std::abs(double(decode_normal(&of[i], NormalY::up).x()));
    CHECK(tilt / double(made.size()) == doctest::Approx(wanted / double(of.size())).epsilon(0.1));
  }
}

TEST_CASE("a map of one value keeps it to the bit, beside others and alone") {
  const auto flat = [](float value, int channels, Semantic semantic) {
    return map_of({40, 40}, channels, semantic, [value](int, int, int) { return value; });
  };
  const MaterialPtr exemplar = Material::make("sand", {{"height", heights({40, 40})},
                                                       {"roughness", flat(0.3f, 1, Semantic::roughness)},
                                                       {"normal", flat(0.5f, 3, Semantic::normal)}});
  const NoiseByExample options{.size = {50, 50}, .cell = 9};
  for (const float v : noise_by_example(*exemplar, options)->find("roughness")->pixels()) REQUIRE(v == 0.3f);
  for (const float v : noise_of(flat(0.7f, 4, Semantic::base_color), options)->pixels()) REQUIRE(v == 0.7f);
}

TEST_CASE("a colour that covers most of an exemplar stays that colour") {
  const ImagePtr map = map_of({64, 64}, 3, Semantic::base_color,
                              [](int x, int y, int c) { return x < 20 && y < 30 ? float(bump(c, x, y)) : 0.0f; });
  int black = 0;
  const std::vector<float> made = noise_of(map, {.size = {128, 128}, .cell = 12, .exemplar_tiles = true})->pixels();
  for (size_t i = 0; i < made.size(); i += 3) black += made[i] == 0 && made[i + 1] == 0 && made[i + 2] == 0;
  CHECK(black > 128 * 128 / 2);
}

TEST_CASE("heights far from 0 keep their precision and their range") {
  const ImagePtr far =
      map_of({64, 64}, 1, Semantic::height, [](int x, int y, int) { return 500 + 0.25f * float(bump(1, x, y)); });
  const ImagePtr near = heights({64, 64});
  const NoiseByExample options{.size = {100, 100}, .cell = 12};
  const std::vector<float> offset = noise_of(far, options)->pixels(), plain = noise_of(near, options)->pixels();
  for (size_t i = 0; i < plain.size(); i++) REQUIRE(std::abs(offset[i] - 500 - 0.25f * plain[i]) < 0.002f);
}

TEST_CASE("values stay within what each channel of the exemplar has, coverage included") {
  const ImagePtr cut = map_of({64, 64}, 4, Semantic::base_color, [](int x, int y, int c) {
    return c == 3 ? (bump(3, x, y) > 0.5 ? 1.0f : 0.25f) : float(bump(c, x, y));
  });
  const std::vector<Distribution> of = Distribution::of(*cut, Task());
  const std::vector<float> made = noise_of(cut, {.size = {90, 90}, .cell = 16})->pixels();
  for (size_t i = 0; i < made.size(); i++) {
    REQUIRE(made[i] >= of[i % 4].min());
    REQUIRE(made[i] <= of[i % 4].max());
  }
}

TEST_CASE("labels and masks are shown, not blended, and belong to what the other maps show most of") {
  const auto label = [](int x, int y) { return float((x / 5 + 3 * (y / 5)) % 7) / 6; };
  const Size size{60, 60};
  const MaterialPtr exemplar = Material::make(
      "both", {{"labels", map_of(size, 1, Semantic::guidance, [&](int x, int y, int) { return label(x, y); })},
               {"mask", map_of(size, 1, Semantic::mask, [&](int x, int y, int) { return label(x, y); })},
               {"height", heights(size)}});
  const MaterialPtr made = noise_by_example(*exemplar, {.size = {100, 100}, .cell = 14});
  std::set<float> known;
  for (int i = 0; i < 7; i++) known.insert(float(i) / 6);
  const std::vector<float> labels = made->find("labels")->pixels();
  for (const float v : labels) REQUIRE(known.contains(v));
  CHECK(labels == made->find("mask")->pixels());
  CHECK(std::set<float>(labels.begin(), labels.end()) == known);
}

TEST_CASE("an exemplar that does not tile is never read across its border; one that does is shown all over") {
  // A step at the border would be seen inside the result: neighbours differ by no more than a ramp does, but for
  // blends.
  const ImagePtr ramp = map_of({64, 64}, 1, Semantic::mask, [](int x, int, int) { return float(x) / 63; });
  const auto jumps = [&](bool tiles, int cell) {
    const std::vector<float> v = noise_of(ramp, {.size = {400, 40}, .cell = cell, .exemplar_tiles = tiles})->pixels();
    int wrapped = 0;
    for (size_t i = 1; i < v.size(); i++) wrapped += v[i - 1] == 1 && v[i] == 0;
    return wrapped;
  };
  CHECK(jumps(false, 16) == 0);
  CHECK(jumps(false, largest_cell({64, 64}, false)) == 0);
  CHECK(jumps(true, 16) > 10);
}

TEST_CASE("exemplars of a few pixels, of one, and narrow ones give results") {
  for (const Size size : {Size{1, 1}, Size{2, 1}, Size{3, 3}, Size{1, 64}})
    for (const bool tiles : {false, true}) {
      const ImagePtr map = heights(size);
      const ImagePtr made = noise_of(map, {.size = {9, 7}, .cell = largest_cell(size, tiles), .exemplar_tiles = tiles});
      const std::vector<float> of = sorted(map->pixels());
      for (const float v : made->pixels()) {
        REQUIRE(v >= of.front());
        REQUIRE(v <= of.back());
      }
    }
}

TEST_CASE("smaller maps are shown at the same places, maps of another shape and values that are no numbers refused") {
  const MaterialPtr exemplar = Material::make(
      "sand", {{"height", heights({64, 64})},
               {"mask", map_of({32, 32}, 1, Semantic::mask, [](int x, int, int) { return float(x) / 31; })}});
  const MaterialPtr made = noise_by_example(*exemplar, {.size = {70, 50}, .cell = 9});
  for (const Map& m : made->maps()) CHECK(m.image->size() == Size{70, 50});
  const MaterialPtr odd = Material::make("odd", {{"height", heights({64, 64})}, {"roughness", heights({64, 32})}});
  CHECK_THROWS_AS(noise_by_example(*odd, {.size = {70, 50}, .cell = 9}), Error);
  const ImagePtr broken = map_of({8, 8}, 1, Semantic::height, [](int x, int, int) {
    return x == 3 ? std::numeric_limits<float>::quiet_NaN() : float(x);
  });
  CHECK_THROWS_AS(noise_of(broken, {.size = {9, 9}, .cell = 2}), Error);
}

TEST_CASE("a cancelled task ends it") {
  std::atomic<bool> cancelled{true};
  CHECK_THROWS_AS(noise_by_example(*Material::of(heights({64, 64})), {.size = {9, 9}, .cell = 4}, Task(&cancelled, {})),
                  Cancelled);
}

TEST_CASE("the physical size grows with the surface") {
  const MaterialPtr exemplar = Material::make("sand", {{"height", heights({50, 40})}}, {2, 1.6});
  const MaterialPtr made = noise_by_example(*exemplar, {.size = {75, 120}, .cell = 9});
  CHECK(made->metres().width == doctest::Approx(3));
  CHECK(made->metres().height == doctest::Approx(4.8));
}
