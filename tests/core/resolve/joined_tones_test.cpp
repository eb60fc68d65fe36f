#include "core/resolve/joined_tones.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/image/normal.h"
#include "core/resolve/resolve.h"
#include "tests/core/resolve/two_pieces.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr Size exemplar_size{128, 96};

float grain(int x, int y) {
  return float(random_bits(1, x, y) % 256) / 255 - 0.5f;
}

/// From dark on the left to bright on the right, with grain of one pixel.
float vignette(int x, int y, float by = 0.02f) {
  return 0.3f + 0.4f * float(x) / 128 + by * grain(x, y);
}

ImagePtr roughness(const std::function<float(int, int)>& value, Size size = exemplar_size) {
  return make_image(
      size, 1, [&](int x, int y, int) { return value(x, y); }, Semantic::roughness);
}

MaterialPtr material(const ImagePtr& map) {
  return Material::of(map);
}

ImagePtr joined(const ImagePtr& map, const UvMapPtr& uv, double reach = 0.0625, ResolveOptions options = {}) {
  const MaterialPtr of = material(map);
  options.tones = slow_tones(*of, *uv, reach);
  return resolved(*of, uv, options)->maps().front().image;
}

ImagePtr exact(const ImagePtr& map, const UvMapPtr& uv) {
  return resolved(*material(map), uv)->maps().front().image;
}

bool same_bits(const std::vector<float>& p, const std::vector<float>& q) {
  return p.size() == q.size() && std::memcmp(p.data(), q.data(), p.size() * sizeof(float)) == 0;
}

double slow_share(const std::function<float(int, int)>& value, bool wraps = false) {
  return SlowTones(roughness(value), exemplar_size, 6, wraps, {}).slow_share();
}

UvMapPtr two_halves(UvWraps wraps = {}) {
  return two_pieces({96, 96}, 48, 32, wraps, exemplar_size);
}

/// The mean of a column.
double column(const Image& image, int x) {
  double sum = 0;
  for (const float v : image.read({x, 0, 1, image.height()})) sum += v / image.height();
  return sum;
}

}  // namespace

TEST_CASE("a vignette is slow, bricks and grain are not, and what is flat has no tones") {
  CHECK(slow_share([](int x, int y) { return vignette(x, y); }) > 0.85);
  CHECK(slow_share([](int x, int y) { return 0.5f + grain(x / 12, y / 6); }) < 0.55);
  CHECK(slow_share([](int x, int y) { return 0.5f + grain(x, y); }) < 0.6);
  CHECK(slow_share([](int, int) { return 0.5f; }) == 0);
}

TEST_CASE("only maps of values that are seen have tones") {
  const UvMapPtr uv = two_halves();
  const auto has = [&](Semantic semantic) {
    const auto value = [](int x, int y, int) { return vignette(x, y); };
    return !slow_tones(*Material::of(make_image(exemplar_size, 1, value, semantic)), *uv, 0.0625).empty();
  };
  for (const Semantic s : {Semantic::base_color, Semantic::roughness, Semantic::ambient_occlusion, Semantic::emission})
    CHECK(has(s));
  for (const Semantic s : {Semantic::height, Semantic::opacity, Semantic::mask, Semantic::guidance, Semantic::data})
    CHECK_FALSE(has(s));
  CHECK(slow_tones(*material(roughness([](int x, int y) { return vignette(x, y); })), *uv, 0).empty());
}

TEST_CASE("a step of tone at a seam becomes a slow change, and the grain on either side stays") {
  const ImagePtr map = roughness([](int x, int y) { return vignette(x, y); });
  const UvMapPtr uv = two_halves();
  const ImagePtr was = exact(map, uv), is = joined(map, uv);
  REQUIRE(column(*was, 48) - column(*was, 47) > 0.09);
  for (int x = 1; x < 96; x++) CHECK(std::abs(column(*is, x) - column(*is, x - 1)) < 0.02);
  // The tone is the same all along a column, so that what differs there is grain.
  for (const int x : {40, 47, 48, 60}) {
    const std::vector<float> a = was->read({x, 0, 1, 96}), b = is->read({x, 0, 1, 96});
    for (size_t y = 1; y < 96; y++) REQUIRE(std::abs((a[y] - a[y - 1]) - (b[y] - b[y - 1])) < 0.004);
  }
}

TEST_CASE("pixels beyond reach of a seam, and of maps whose tones are not slow, stay bit for bit") {
  const UvMapPtr uv = two_halves();
  const ImagePtr slow = roughness([](int x, int y) { return vignette(x, y); });
  const ImagePtr is = joined(slow, uv), was = exact(slow, uv);
  for (const Rect far : {Rect{0, 0, 30, 96}, Rect{66, 0, 30, 96}}) CHECK(same_bits(is->read(far), was->read(far)));
  CHECK_FALSE(same_bits(is->pixels(), was->pixels()));
  const ImagePtr bricks = roughness([](int x, int y) { return 0.5f + grain(x / 12, y / 6); });
  CHECK(same_bits(joined(bricks, uv)->pixels(), exact(bricks, uv)->pixels()));
}

TEST_CASE("tones meet across the border of a result that wraps, and only there") {
  const ImagePtr map = roughness([](int x, int y) { return vignette(x, y, 0); });
  const auto across = [&](UvWraps wraps) {
    const ImagePtr out = joined(map, two_pieces({97, 40}, 97, 0, wraps, exemplar_size));
    return column(*out, 0) - column(*out, 96);
  };
  CHECK(across({}) == doctest::Approx(-0.4 * 96 / 128));
  CHECK(across({.y = true}) == doctest::Approx(-0.4 * 96 / 128));
  CHECK(std::abs(across({.x = true})) < 0.1);
}

TEST_CASE("joined tones stay within the exemplar's range; what is not finite stays, and does not spread") {
  const ImagePtr map = roughness([](int x, int y) { return x == 90 && y == 40 ? NAN : vignette(x, y); });
  const UvMapPtr uv = two_pieces({96, 96}, 48, 32, {}, exemplar_size);
  const ImagePtr is = joined(map, uv), was = exact(map, uv);
  const std::vector<float> p = is->pixels(), q = was->pixels();
  int nans = 0;
  for (size_t i = 0; i < p.size(); i++) {
    REQUIRE(std::isnan(p[i]) == std::isnan(q[i]));
    nans += std::isnan(p[i]) ? 1 : 0;
    if (!std::isnan(p[i])) REQUIRE((p[i] >= 0.28f && p[i] <= 0.72f));
  }
  CHECK(nans == 1);
}

TEST_CASE("joined normals keep their length, and alpha stays") {
  const UvMapPtr uv = two_halves();
  const ImagePtr normals = make_image(
      exemplar_size, 3,
      [](int x, int, int c) {
        float pixel[3];
        encode_normal(normalized({float(x) / 128 - 0.5f, 0.1f, 1}), NormalY::up, pixel);
        return pixel[c];
      },
      Semantic::normal);
  const ImagePtr is = joined(normals, uv);
  CHECK_FALSE(same_bits(is->pixels(), exact(normals, uv)->pixels()));
  const std::vector<float> pixels = is->pixels();
  for (size_t i = 0; i < pixels.size(); i += 3)
    REQUIRE(length(decode_normal(&pixels[i], NormalY::up)) == doctest::Approx(1).epsilon(1e-4));

  const ImagePtr color = make_image(
      exemplar_size, 4, [](int x, int y, int c) { return c == 3 ? float(x % 2) : vignette(x, y); },
      Semantic::base_color, "srgb_texture");
  const std::vector<float> before = exact(color, uv)->pixels(), after = joined(color, uv)->pixels();
  for (size_t i = 3; i < after.size(); i += 4) REQUIRE(after[i] == before[i]);
}

TEST_CASE("kept pixels stay bit for bit, and the tones beside them turn to theirs") {
  const ImagePtr map = roughness([](int x, int y) { return vignette(x, y); });
  const UvMapPtr uv = two_halves();
  const ImagePtr was = exact(map, uv);
  const auto kept = material(make_image(
      {48, 96}, 1,
      [&](int x, int y, int) {
        return was->read({x, y, 1, 1})[0];
      },
      Semantic::roughness));
  const ImagePtr is = joined(map, uv, 0.0625, {.kept = kept});
  CHECK(same_bits(is->read({0, 0, 48, 96}), was->read({0, 0, 48, 96})));
  CHECK(std::abs(column(*is, 48) - column(*is, 47)) < 0.03);
  // In a hole nothing is kept.
  const ImagePtr all = make_image(
      {1, 1}, 1, [](int, int, int) { return 1.0f; }, Semantic::mask);
  CHECK(same_bits(joined(map, uv, 0.0625, {.kept = kept, .holes = all})->pixels(), joined(map, uv)->pixels()));
  const MaterialPtr other = Material::make("m", {{"height", map}});
  CHECK_THROWS_WITH_AS(joined(map, uv, 0.0625, {.kept = other}), doctest::Contains("expected the map \"roughness\""),
                       Error);
}

TEST_CASE("any window of joined tones is that window of the whole, with any number of threads") {
  for (const UvWraps wraps : {UvWraps{}, {.x = true}, {.x = true, .y = true, .exemplar = true}}) {
    const UvMapPtr uv = two_pieces({201, 151}, 77, 50, wraps, exemplar_size);
    const ImagePtr map = roughness([](int x, int y) { return vignette(x, y); });
    const ImagePtr out = joined(map, uv);
    std::vector<float> whole;
    tbb::task_arena(7).execute([&] { whole = out->pixels(); });
    for (const Rect part : {Rect{0, 0, 1, 1}, Rect{70, 3, 20, 140}, Rect{1, 100, 200, 7}, Rect{198, 149, 3, 2}}) {
      const std::vector<float> found = out->read(part);
      for (int y = 0; y < part.height; y++)
        for (int x = 0; x < part.width; x++)
          REQUIRE(found[size_t(y * part.width + x)] == whole[size_t((part.y + y) * 201 + part.x + x)]);
    }
  }
}

TEST_CASE("tones of maps in other sizes than the exemplar, tiny ones and great reaches are no trouble") {
  const UvMapPtr uv = two_halves();
  const MaterialPtr both = Material::make(
      "m", {{"roughness", roughness([](int x, int y) { return vignette(x, y); })},
            {"metallic",
             make_image(
                 {32, 24}, 1, [](int x, int y, int) { return vignette(4 * x, 4 * y, 0); }, Semantic::metallic)}});
  const MaterialPtr out = resolved(*both, uv, {.tones = slow_tones(*both, *uv, 0.0625)});
  const ImagePtr metallic = out->find("metallic");
  CHECK(metallic->size() == Size{96, 96});
  CHECK(std::abs(column(*metallic, 48) - column(*metallic, 47)) < 0.04);
  for (const double reach : {0.001, 0.9, 1.0, 500.0})
    CHECK(joined(both->maps().front().image, uv, reach)->pixels().size() == 96 * 96);
  const UvMapPtr small = two_pieces({3, 2}, 1, 0, {}, {1, 1});
  CHECK(joined(roughness([](int, int) { return 1.0f; }, {1, 1}), small)->pixels() == std::vector<float>(6, 1.0f));
}
