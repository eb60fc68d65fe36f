#include "core/resolve/joined_heights.h"

#include <cmath>
#include <cstring>
#include <limits>

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/resolve/resolve.h"
#include "tests/core/resolve/two_pieces.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr Size exemplar_size{64, 48};

using Height = std::function<float(int, int)>;

ImagePtr heights(const Height& height, Size size = exemplar_size) {
  return make_image(
      size, 1, [&](int x, int y, int) { return height(x, y); }, Semantic::height);
}

float noise(int x, int y) {
  return float(random_bits(1, x, y) % 256) / 255;
}

/// Patches of about 10x7 pixels from anywhere.
UvMapPtr patchwork(Size size, UvWraps wraps = {}, Size exemplar = exemplar_size) {
  std::vector<ExemplarPixel> pixels;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const uint64_t patch = random_bits(2, x / 10, y / 7);
      pixels.push_back({uint16_t((patch % 1000 + uint64_t(x)) % uint64_t(exemplar.width)),
                        uint16_t((patch / 1000 % 1000 + uint64_t(y)) % uint64_t(exemplar.height))});
    }
  return UvMap::make(size, exemplar, std::move(pixels), wraps);
}

ImagePtr shown(const ImagePtr& map, const UvMapPtr& uv, double join, double scale = 1) {
  return resolved(*Material::of(map), uv, {.join = join, .scale = scale})->maps().front().image;
}

/// Steps along the middle row.
std::vector<double> steps(const Image& image) {
  const std::vector<float> row = image.read({0, image.height() / 2, image.width(), 1});
  std::vector<double> out;
  for (size_t x = 1; x < row.size(); x++) out.push_back(double(row[x]) - double(row[x - 1]));
  return out;
}

/// Whether two images have the same pixels, bit for bit, NaNs too.
bool same_bits(const Image& a, const Image& b) {
  const std::vector<float> p = a.pixels(), q = b.pixels();
  return p.size() == q.size() && std::memcmp(p.data(), q.data(), p.size() * sizeof(float)) == 0;
}

}  // namespace

TEST_CASE("a step that neither piece has at a seam goes, and slopes elsewhere stay nearly what they were") {
  const ImagePtr slope = heights([](int x, int) { return 0.2f + float(x) / 256; }, {128, 48});
  const UvMapPtr uv = two_pieces({64, 48}, 32, 30, {}, {128, 48});
  REQUIRE(steps(*shown(slope, uv, 0))[31] == doctest::Approx(31.0 / 256));
  for (const double reach : {8.0, 32.0}) {
    const std::vector<double> found = steps(*shown(slope, uv, reach));
    // What was a step is made up for by a slope on both sides: half of it within the reach.
    const double most = 30.0 / 256 / 2 / reach;
    for (const double step : found) CHECK(std::abs(step - 1.0 / 256) < 1.2 * most + 0.001);
  }
}

TEST_CASE("pieces of different height but the same details come out as one, the difference spread around the seam") {
  const auto detail = [](int x, int y) { return 0.1f * noise(x % 20, y); };
  const ImagePtr map = heights([&](int x, int y) { return detail(x, y) + (x < 100 ? 0.2f : 0.6f); }, {200, 60});
  const UvMapPtr uv = two_pieces({90, 60}, 40, 100, {}, {200, 60});
  const ImagePtr out = shown(map, uv, 10), exact = shown(map, uv, 0);
  for (int y = 0; y < 60; y++) {
    const std::vector<float> row = out->read({0, y, 90, 1}), was = exact->read({0, y, 90, 1});
    for (int x = 1; x < 90; x++) {
      const double step = double(row[size_t(x)]) - double(row[size_t(x) - 1]);
      REQUIRE(std::abs(step - double(detail(x, y) - detail(x - 1, y))) < 1.3 * 0.4 / 2 / 10);
    }
    CHECK(row[39] == doctest::Approx(double(was[39]) + 0.2).epsilon(0.05));
    CHECK(row[0] == doctest::Approx(double(was[0])).epsilon(0.05));
  }
}

TEST_CASE("cliffs that the exemplar has stay: within a piece, and at a seam where either piece has one") {
  // Stairs of 16 pixels, one up, one down; pieces that meet at an edge, in step.
  const ImagePtr stairs = heights([](int x, int y) { return x / 16 % 2 == 1 ? 0.9f : 0.1f + 0.01f * float(y % 3); });
  const UvMapPtr both = two_pieces({32, 48}, 16, 32);
  CHECK(same_bits(*shown(stairs, both, 16), *shown(stairs, both, 0)));
  // The left piece ends where its cliff begins; the right one is high all along.
  const ImagePtr one = heights([](int x, int) { return x < 16 ? 0.1f : 0.9f; });
  const UvMapPtr left = two_pieces({32, 48}, 16, 20);
  CHECK(same_bits(*shown(one, left, 16), *shown(one, left, 0)));
  // The same cliff in the middle of a piece that is raised as a whole.
  const ImagePtr cliff = heights([](int x, int) { return x < 20 ? 0.5f : x < 40 ? 0.3f : 0.7f; });
  const UvMapPtr raised = two_pieces({40, 48}, 10, 20);
  const std::vector<double> found = steps(*shown(cliff, raised, 16));
  CHECK(found[19] == doctest::Approx(0.4).epsilon(0.05));
  CHECK(std::abs(found[9]) < 0.01);
}

TEST_CASE("heights stay within those of the exemplar, whatever the pieces") {
  const ImagePtr map = heights([](int x, int y) { return 0.25f + 0.5f * noise(x, y); });
  const std::vector<float> all = map->pixels();
  const auto [low, high] = std::minmax_element(all.begin(), all.end());
  for (const double reach : {2.0, 50.0, 1024.0})
    for (const float v : shown(map, patchwork({90, 70}), reach)->pixels()) {
      REQUIRE(v >= *low);
      REQUIRE(v <= *high);
    }
}

TEST_CASE("a result that wraps is joined across its border") {
  const ImagePtr slope = heights([](int x, int) { return 0.2f + float(x) / 256; });
  const auto across = [&](UvWraps wraps) {
    const ImagePtr out = shown(slope, two_pieces({41, 30}, 41, 0, wraps), 8);
    return double(out->read({0, 15, 1, 1})[0]) - double(out->read({40, 15, 1, 1})[0]);
  };
  CHECK(across({}) == doctest::Approx(-40.0 / 256));
  CHECK(across({.y = true}) == doctest::Approx(-40.0 / 256));
  CHECK(std::abs(across({.x = true})) < 0.02);
}

TEST_CASE("pieces that go on around an exemplar that tiles have no seam there") {
  const ImagePtr map = heights(noise);
  const UvMapPtr uv = two_pieces({64, 48}, 0, 20, {.exemplar = true});
  CHECK(same_bits(*shown(map, uv, 8), *shown(map, uv, 0)));
}

TEST_CASE("any window of joined heights is that window of the whole, bit for bit") {
  for (const UvWraps wraps : {UvWraps{}, {.x = true}, {.x = true, .y = true, .exemplar = true}}) {
    for (const MaterialPtr& kept : {MaterialPtr(), Material::of(heights([](int, int) { return 0.5f; }))}) {
      const ResolveOptions options{.join = 20, .kept = kept, .kept_at = {250, 40}};
      const ImagePtr out =
          resolved(*Material::of(heights(noise)), patchwork({301, 147}, wraps), options)->maps().front().image;
      const std::vector<float> all = out->pixels();
      for (const Rect& part :
           {Rect{0, 0, 1, 1}, {300, 146, 1, 1}, {0, 60, 301, 3}, {250, 60, 31, 87}, {7, 5, 260, 100}}) {
        const std::vector<float> window = out->read(part);
        for (int y = 0; y < part.height; y++)
          for (int x = 0; x < part.width; x++)
            REQUIRE(window[size_t(y * part.width + x)] == all[size_t((y + part.y) * 301 + x + part.x)]);
      }
    }
  }
}

TEST_CASE("what is kept stays bit for bit, and what lies beside it gives way to it all") {
  const auto detail = [](int x, int y) { return 0.05f * noise(x % 20, y); };
  const ImagePtr map = heights([&](int x, int y) { return detail(x, y) + (x < 100 ? 0.2f : 0.6f); }, {200, 60});
  const UvMapPtr uv = two_pieces({90, 60}, 40, 100, {}, {200, 60});
  // The left piece is kept, lifted by as much as no slope asks for; but for a hole in it.
  const ImagePtr kept = heights([&](int x, int y) { return 0.15f + detail(x, y) + 0.2f; }, {40, 60});
  const ImagePtr hole =
      make_image({90, 60}, 1, [](int x, int y, int) { return x >= 10 && x < 20 && y >= 10 && y < 20 ? 1.0f : 0.0f; });
  const ImagePtr out =
      resolved(*Material::of(map), uv, {.join = 10, .kept = Material::of(kept), .holes = hole})->maps().front().image;
  const std::vector<float> found = out->pixels(), exact = kept->pixels();
  const auto at = [&](int x, int y) { return found[size_t(y * 90 + x)]; };
  for (int y = 0; y < 60; y++) {
    CAPTURE(y);
    for (int x = 0; x < 40; x++)
      if (hole->pixels()[size_t(y * 90 + x)] == 0) REQUIRE(at(x, y) == exact[size_t(y * 40 + x)]);
    // Of the 0.25 that the right piece is higher nothing is seen at the seam, and all of it far away.
    CHECK(at(40, y) - detail(40, y) == doctest::Approx(0.35).epsilon(0.08));
    CHECK(at(89, y) - detail(89, y) == doctest::Approx(0.6).epsilon(0.05));
  }
  for (int i = 10; i < 20; i++) CHECK(at(i, 15) - detail(i, 15) == doctest::Approx(0.35).epsilon(0.05));
}

TEST_CASE("what is kept may lie anywhere, reach beyond the result, and lack the map only where nothing is joined") {
  const UvMapPtr uv = patchwork({90, 70}, {.x = true});
  const MaterialPtr map = Material::of(heights(noise)), kept = Material::of(heights([](int, int) { return 0.5f; }));
  const ImagePtr out = resolved(*map, uv, {.join = 9, .kept = kept, .kept_at = {60, 50}})->maps().front().image;
  for (const float v : out->read({60, 50, 30, 20})) REQUIRE(v == 0.5f);
  CHECK(out->read({0, 0, 60, 50}) != resolved(*map, uv, {.join = 9})->maps().front().image->read({0, 0, 60, 50}));
  CHECK(same_bits(*resolved(*map, uv, {.kept = kept})->maps().front().image, *shown(map->maps().front().image, uv, 0)));
  const MaterialPtr other = Material::make("m", {{"roughness", heights(noise)}});
  CHECK_THROWS_WITH_AS(resolved(*map, uv, {.join = 9, .kept = other}), doctest::Contains("expected the map \"height\""),
                       Error);
}

TEST_CASE("joined heights are the same bits with any number of threads") {
  const auto pixels = [](int threads) {
    std::vector<float> out;
    tbb::task_arena(threads).execute([&] { out = shown(heights(noise), patchwork({300, 300}), 0.5)->pixels(); });
    return out;
  };
  const std::vector<float> one = pixels(1);
  CHECK(one == pixels(2));
  CHECK(one == pixels(7));
}

TEST_CASE("results and exemplars of any size are joined") {
  for (const Size size : {Size{1, 1}, {1, 40}, {40, 1}, {2, 3}, {3, 2}, {300, 2}})
    for (const bool wraps : {false, true})
      for (const Size exemplar : {Size{1, 1}, {16, 1}, {1, 16}, {5, 7}}) {
        const ImagePtr map = heights(noise, exemplar);
        for (const double reach : {1e-300, 0.5, 3.0, 1024.0})
          for (const float v :
               shown(map, patchwork(size, {.x = wraps, .y = wraps, .exemplar = wraps}, exemplar), reach)->pixels())
            REQUIRE((v >= 0 && v <= 1));
      }
}

TEST_CASE("what is not finite stays where it is shown and moves nothing; values of any magnitude are joined") {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  const float huge = std::numeric_limits<float>::max();
  const ImagePtr map = heights([&](int x, int y) {
    const uint64_t kind = random_bits(5, x, y) % 20;
    return kind == 0 ? nan : kind == 1 ? infinity : kind == 2 ? -infinity : kind == 3 ? huge : kind == 4 ? -huge : 0.0f;
  });
  const UvMapPtr uv = patchwork({90, 70});
  const std::vector<float> out = shown(map, uv, 9)->pixels(), was = shown(map, uv, 0)->pixels();
  for (size_t i = 0; i < out.size(); i++) {
    REQUIRE(std::isfinite(out[i]) == std::isfinite(was[i]));
    REQUIRE(std::isnan(out[i]) == std::isnan(was[i]));
  }
  for (const float flat : {nan, infinity, 0.5f}) {
    const ImagePtr same = heights([&](int, int) { return flat; });
    CHECK(same_bits(*shown(same, uv, 9), *shown(same, uv, 0)));
  }
  // A hole beside a seam: the other piece alone says how the heights go on there.
  const ImagePtr hole = heights([&](int x, int) { return x >= 16 && x < 30 ? nan : x < 30 ? 0.2f : 0.8f; });
  const UvMapPtr beside = two_pieces({32, 48}, 16, 20);
  CHECK(std::abs(steps(*shown(hole, beside, 8))[15]) < 0.05);
}

TEST_CASE("only height maps of one channel are joined") {
  const UvMapPtr uv = two_pieces({32, 24}, 16, 20);
  for (const auto& [semantic, channels] : {std::pair(Semantic::base_color, 3),
                                           {Semantic::normal, 3},
                                           {Semantic::roughness, 1},
                                           {Semantic::mask, 1},
                                           {Semantic::data, 1},
                                           {Semantic::height, 2}}) {
    const ImagePtr map = make_image(
        exemplar_size, channels, [](int x, int y, int c) { return noise(x, y + 100 * c); }, semantic);
    CHECK(same_bits(*shown(map, uv, 8), *shown(map, uv, 0)));
  }
  CHECK(shown(heights(noise), uv, 8)->info() == shown(heights(noise), uv, 0)->info());
  CHECK(!same_bits(*shown(heights(noise), uv, 8), *shown(heights(noise), uv, 0)));
}

TEST_CASE("joined heights are not blended, and blended colours not joined") {
  const MaterialPtr material = Material::make(
      "m", {{"base_color", make_image(
                               exemplar_size, 3, [](int x, int y, int) { return noise(x, y); }, Semantic::base_color)},
            {"height", heights(noise)}});
  const UvMapPtr uv = two_pieces({32, 24}, 16, 20);
  const auto map = [&](const char* name, const ResolveOptions& options) {
    return resolved(*material, uv, options)->find(name);
  };
  CHECK(same_bits(*map("height", {.blend = 3, .join = 8}), *map("height", {.join = 8})));
  CHECK(same_bits(*map("base_color", {.blend = 3, .join = 8}), *map("base_color", {.blend = 3})));
}

TEST_CASE("a reach below 1 is a part of the shorter side of the exemplar that was analysed") {
  const ImagePtr map = heights(noise), fine = heights([](int x, int y) { return noise(x / 3, y / 3); }, {192, 144});
  const UvMapPtr uv = patchwork({90, 70});
  CHECK(same_bits(*shown(map, uv, 0.125), *shown(map, uv, 6)));
  CHECK(!same_bits(*shown(map, uv, 0.125), *shown(map, uv, 8)));
  CHECK(same_bits(*shown(fine, uv, 0.125, 3), *shown(fine, uv, 6, 3)));
}

TEST_CASE("larger exemplars and smaller maps are joined as well") {
  const auto ramp = [](Size size) {
    return heights([size](int x, int) { return 0.8f * float(x) / float(size.width); }, size);
  };
  const UvMapPtr uv = two_pieces({32, 24}, 16, 20);
  const ImagePtr fine = shown(ramp({192, 144}), uv, 8, 3);
  REQUIRE(fine->size() == Size{96, 72});
  CHECK(std::abs(steps(*fine)[47]) < 0.02);
  const MaterialPtr material = Material::make(
      "m", {{"base_color", make_image(
                               exemplar_size, 3, [](int, int, int) { return 0.5f; }, Semantic::base_color)},
            {"height", ramp({32, 24})}});
  const ImagePtr small = resolved(*material, uv, {.join = 8})->find("height");
  REQUIRE(small->size() == Size{32, 24});
  CHECK(std::abs(steps(*small)[15]) < 0.05);
}
