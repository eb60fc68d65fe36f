#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "core/base/hash.h"
#include "core/image/normal.h"
#include "core/image/srgb.h"
#include "core/resolve/resolve.h"
#include "tests/core/resolve/two_pieces.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr Size exemplar_size{64, 48};

float noise(int which, int x, int y, int c) {
  return float(random_bits(which, x, y, c) % 256) / 255;
}

ImagePtr noise_map(int channels, Semantic semantic, Size size = exemplar_size) {
  return make_image(
      size, channels, [](int x, int y, int c) { return noise(1, x, y, c); }, semantic);
}

ImagePtr shown(const ImagePtr& map, const UvMapPtr& uv, const ResolveOptions& options) {
  return resolved(*Material::of(map), uv, options)->maps().front().image;
}

/// The columns in which two images differ.
std::vector<int> changed_columns(const Image& a, const Image& b) {
  const std::vector<float> p = a.pixels(), q = b.pixels();
  std::vector<int> columns;
  for (int x = 0; x < a.width(); x++) {
    bool same = true;
    for (int y = 0; y < a.height(); y++)
      for (int c = 0; c < a.channels(); c++) {
        const size_t at = (size_t(y) * a.width() + x) * a.channels() + c;
        same = same && p[at] == q[at];
      }
    if (!same) columns.push_back(x);
  }
  return columns;
}

double largest_step(const Image& image) {
  const std::vector<float> p = image.pixels();
  double largest = 0;
  for (int y = 0; y < image.height(); y++)
    for (int x = 1; x < image.width(); x++)
      largest = std::max(largest, std::abs(double(p[y * image.width() + x]) - p[y * image.width() + x - 1]));
  return largest;
}

}  // namespace

TEST_CASE("blending changes pixels nearer to a seam than its radius, and no other by a single bit") {
  const UvMapPtr uv = two_pieces({32, 24}, 16, 20);
  for (const Semantic semantic : {Semantic::base_color, Semantic::normal}) {
    const ImagePtr map = noise_map(3, semantic);
    const ImagePtr exact = shown(map, uv, {});
    CHECK(changed_columns(*exact, *shown(map, uv, {.blend = 1})).empty());
    CHECK(changed_columns(*exact, *shown(map, uv, {.blend = 2})) == std::vector<int>{15, 16});
    CHECK(changed_columns(*exact, *shown(map, uv, {.blend = 3.5})) == std::vector<int>{13, 14, 15, 16, 17, 18});
  }
}

TEST_CASE("colours are averaged in linear light with the kernel's weights") {
  const ImagePtr map = make_image(
      exemplar_size, 3, [](int x, int, int) { return x < 32 ? 0.0f : 1.0f; }, Semantic::base_color, "srgb_texture");
  const ImagePtr out = shown(map, two_pieces({32, 8}, 16, 30), {.blend = 2});
  // At radius 2 a pixel weighs 1, its four neighbours 9/16 and the diagonal ones 1/4: a quarter lies across the seam.
  CHECK(out->read({15, 4, 1, 1})[0] == doctest::Approx(encode_srgb(0.25)));
  CHECK(out->read({16, 4, 1, 1})[2] == doctest::Approx(encode_srgb(0.75)));
}

TEST_CASE("heights become continuous: the largest step across a seam falls with the radius") {
  const ImagePtr slope = make_image(
      exemplar_size, 1, [](int x, int, int) { return float(x) / 64; }, Semantic::height);
  const UvMapPtr uv = two_pieces({32, 24}, 16, 20);
  const double step = largest_step(*shown(slope, uv, {}));
  CHECK(step == doctest::Approx(21.0 / 64));
  CHECK(largest_step(*shown(slope, uv, {.blend = 2})) < 0.6 * step);
  CHECK(largest_step(*shown(slope, uv, {.blend = 4})) < 0.35 * step);
}

TEST_CASE("blended normals are the pieces' mean direction, of unit length, in the map's own convention") {
  for (const NormalY normal_y : {NormalY::up, NormalY::down}) {
    const ImageInfo info{.size = exemplar_size, .channels = 3, .semantic = Semantic::normal, .normal_y = normal_y};
    std::vector<float> pixels(size_t(info.size.area()) * 3);
    for (int i = 0; i < info.size.area(); i++)
      encode_normal(normalized({0, i % info.size.width < 32 ? 1.0f : -1.0f, 1}), normal_y, &pixels[size_t(i) * 3]);
    const ImagePtr map = Image::from_floats(info, std::move(pixels));
    const ImagePtr out = shown(map, two_pieces({32, 8}, 16, 30), {.blend = 2});
    const Vector3f left = decode_normal(out->read({15, 4, 1, 1}).data(), normal_y);
    const Vector3f expected = normalized({0, 0.5f, 1});
    for (int c = 0; c < 3; c++) CHECK(left[c] == doctest::Approx(expected[c]).epsilon(1e-5));
  }
}

TEST_CASE("details keep most of their contrast where unlike pieces are blended") {
  const ImagePtr map = noise_map(1, Semantic::height, {64, 600});
  const UvMapPtr uv = two_pieces({32, 600}, 16, 20, {}, {64, 600});
  const auto deviation = [](const ImagePtr& image) {
    double sum = 0, squares = 0;
    for (const float v : image->read({15, 0, 2, 600})) {
      sum += v;
      squares += double(v) * v;
    }
    return std::sqrt(squares / 1200 - sum / 1200 * sum / 1200);
  };
  // A plain mean with weights of a quarter and three quarters would keep sqrt(5/8) = 0.79 of it.
  CHECK(deviation(shown(map, uv, {.blend = 2})) > 0.86 * deviation(shown(map, uv, {})));
}

TEST_CASE("where pieces agree, blending adds nothing to them") {
  const ImagePtr stripes = make_image(
      exemplar_size, 1, [](int x, int y, int) { return float((x + y) % 4) / 4 + 0.1f; }, Semantic::height);
  const UvMapPtr uv = two_pieces({32, 24}, 16, 20);
  CHECK(shown(stripes, uv, {.blend = 4})->pixels() == shown(stripes, uv, {})->pixels());
}

TEST_CASE("normals that are too short stay as short as their neighbours") {
  const ImageInfo info{.size = exemplar_size, .channels = 3, .semantic = Semantic::normal};
  std::vector<float> pixels(size_t(info.size.area()) * 3);
  for (int i = 0; i < info.size.area(); i++) {
    const Vector3f n = normalized({noise(1, i, 0, 0) - 0.5f, noise(1, i, 0, 1) - 0.5f, 0.5f});
    encode_normal({n[0] * 0.6f, n[1] * 0.6f, n[2] * 0.6f}, NormalY::up, &pixels[size_t(i) * 3]);
  }
  const ImagePtr out = shown(Image::from_floats(info, std::move(pixels)), two_pieces({32, 24}, 16, 20), {.blend = 3});
  for (int y = 0; y < 24; y++)
    for (int x = 12; x < 20; x++) {
      const Vector3f n = decode_normal(out->read({x, y, 1, 1}).data(), NormalY::up);
      REQUIRE(std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) == doctest::Approx(0.6).epsilon(1e-4));
    }
}

TEST_CASE("masks and data stay exact beside maps that are blended") {
  const UvMapPtr uv = two_pieces({32, 24}, 16, 20);
  for (const Semantic semantic : {Semantic::mask, Semantic::data}) {
    const ImagePtr map = noise_map(1, semantic);
    CHECK(changed_columns(*shown(map, uv, {}), *shown(map, uv, {.blend = 4})).empty());
  }
}

TEST_CASE("seams of a result that wraps are blended across its border") {
  const ImagePtr map = noise_map(3, Semantic::base_color);
  const auto changed = [&](UvWraps wraps) {
    const UvMapPtr uv = two_pieces({32, 24}, 0, 10, wraps);
    return changed_columns(*shown(map, uv, {}), *shown(map, uv, {.blend = 2}));
  };
  CHECK(changed({}).empty());
  CHECK(changed({.x = true}) == std::vector<int>{0, 31});
}

TEST_CASE(
    "a piece that goes around a tiling exemplar has no seam there, and proposals beyond one that does not tile "
    "are left out") {
  const ImagePtr map = noise_map(3, Semantic::base_color);
  const auto changed = [&](UvWraps wraps) {
    const UvMapPtr uv = two_pieces({32, 24}, 0, 48, wraps);
    return changed_columns(*shown(map, uv, {}), *shown(map, uv, {.blend = 2}));
  };
  CHECK(changed({.exemplar = true}).empty());
  // Columns 48 to 63, then 0 to 15: neither piece can be continued over the border, so there is nothing to blend.
  CHECK(changed({}).empty());
}

TEST_CASE("a larger exemplar is shown block by block, or as one piece where the uv map is") {
  const ImagePtr fine = noise_map(3, Semantic::base_color, {192, 144});
  const UvMapPtr uv = two_pieces({32, 24}, 16, 20);
  for (const double scale : {3.0, 0.0}) {
    const ImagePtr out = shown(fine, uv, {.scale = scale});
    REQUIRE(out->size() == Size{96, 72});
    for (int y = 0; y < 72; y++)
      for (int x = 0; x < 96; x++)
        for (int c = 0; c < 3; c++) REQUIRE(out->read({x, y, 1, 1})[c] == noise(1, x < 48 ? x : x + 60, y, c));
  }
}

TEST_CASE("seam weights of a larger exemplar are those of its own pixels") {
  const ImagePtr fine = noise_map(3, Semantic::base_color, {256, 192});
  const UvMapPtr uv = two_pieces({32, 24}, 16, 20);
  const ImagePtr exact = shown(fine, uv, {.scale = 4}), blended = shown(fine, uv, {.blend = 1, .scale = 4});
  // The nearest pixel centres across lie half a pixel of the uv map beyond the seam: two of the exemplar's.
  CHECK(changed_columns(*exact, *blended) == std::vector<int>{62, 63, 64, 65});
  const std::vector<float> all = blended->pixels(), window = blended->read({61, 30, 5, 3});
  for (int y = 0; y < 3; y++)
    for (int i = 0; i < 15; i++) REQUIRE(window[y * 15 + i] == all[((y + 30) * 128 + 61) * 3 + i]);
}

TEST_CASE("scales that are no whole number keep pieces exact") {
  const ImagePtr fine = noise_map(3, Semantic::base_color, {96, 72});
  const UvMapPtr uv = two_pieces(exemplar_size, 64, 0);
  const ImagePtr out = shown(fine, uv, {.blend = 2, .scale = 1.5});
  CHECK(out->pixels() == fine->pixels());
  const ImagePtr odd = noise_map(1, Semantic::height, {101, 75});
  CHECK(shown(odd, uv, {.scale = 0})->pixels() == odd->pixels());
}

TEST_CASE("smaller maps of a larger exemplar are sampled at the same place") {
  const MaterialPtr material = Material::make("m", {{"base_color", noise_map(3, Semantic::base_color, {128, 96})},
                                                    {"roughness", noise_map(1, Semantic::roughness, {64, 48})}});
  const MaterialPtr out = resolved(*material, two_pieces({32, 24}, 16, 20), {.scale = 2});
  const ImagePtr rough = out->find("roughness");
  REQUIRE(rough->size() == Size{64, 48});
  for (int x = 0; x < 64; x++) REQUIRE(rough->read({x, 9, 1, 1})[0] == noise(1, (x < 32 ? x : x + 40) / 2, 4, 0));
}
