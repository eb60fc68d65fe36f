#include <cmath>

#include <doctest/doctest.h>

#include "nodes/common/registry.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr double pi = 3.14159265358979324;

ImagePtr made(const ImagePtr& normal, const Params& params) {
  return run_image("make_height", params, {{"normal", normal}});
}

ImagePtr bumps(Size size, double wavelength) {
  const double w = 2 * pi / wavelength;
  return make_image(
      size, 1,
      [w](int x, int y, int) {
        return float(0.5 + 0.2 * std::sin(w * x + 1) * std::sin(w * y) + 0.1 * std::cos(w * x));
      },
      Semantic::height);
}

double mean_of(const Image& image) {
  double sum = 0;
  for (const float v : image.pixels()) sum += v;
  return sum / double(image.size().area());
}

/// What the way to normals and back changes, but for a constant.
double round_trip(const ImagePtr& height, const Params& normal_params, const Params& height_params) {
  const ImagePtr back = made(run_image("make_normal", normal_params, {{"height", height}}), height_params);
  const double shift = mean_of(*back) - mean_of(*height);
  const std::vector<float> before = height->pixels(), after = back->pixels();
  double worst = 0;
  for (size_t i = 0; i < before.size(); i++) worst = std::max(worst, std::abs(after[i] - before[i] - shift));
  return worst;
}

}  // namespace

TEST_CASE("from height to normals and back gives the height again, for every filter, convention and border") {
  for (const std::string filter : {"scharr", "sobel", "central"})
    for (const std::string edges : {"clamp", "wrap"})
      for (const std::string normal_y : {"up", "down"})
        for (const double height_scale : {8.0, -20.0}) {
          CAPTURE(filter);
          CAPTURE(edges);
          Params params{{"height_scale", height_scale}, {"filter", filter}, {"edges", edges}};
          Params with_y = params;
          with_y["normal_y"] = normal_y;
          // Of a relief of 0.6, 0.05 % where it wraps; 0.3 % where borders clamp.
          CHECK(round_trip(bumps({96, 72}, 24), with_y, params) < (edges == "wrap" ? 0.0003 : 0.0018));
        }
}

TEST_CASE("short waves come back within half a percent") {
  const Params params{{"height_scale", 6.0}, {"edges", "wrap"}};
  CHECK(round_trip(bumps({96, 72}, 12), params, params) < 0.005 * 0.6);
}

TEST_CASE("a ramp comes back as a ramp, and is clipped in 16 bits only") {
  const ImagePtr ramp = make_image(
      {40, 30}, 1, [](int x, int y, int) { return 0.02f * float(x) + 0.01f * float(y); }, Semantic::height);
  CHECK(round_trip(ramp, {{"height_scale", 30.0}}, {{"height_scale", 30.0}}) < 1e-4);
  const ImagePtr normals = run_image("make_normal", {{"height_scale", 30.0}}, {{"height", ramp}});
  const NodeRun run = run_node("make_height", {{"height_scale", 10.0}}, {{"normal", {with_depth(normals, Depth::u8)}}});
  CHECK(run.get<Image>("height")->info().depth == Depth::u16);
  CHECK(run.says("lies outside 0..1"));
  for (const float h : run.get<Image>("height")->pixels()) CHECK((h >= 0 && h <= 1));
}

TEST_CASE("heights lie where the range says") {
  const ImagePtr height = bumps({48, 48}, 24);
  const auto range = [&](const std::string& name, double scale) {
    const ImagePtr normals =
        run_image("make_normal", {{"height_scale", 10.0}, {"edges", "wrap"}}, {{"height", height}});
    const std::vector<float> p = made(normals, {{"height_scale", scale}, {"range", name}, {"edges", "wrap"}})->pixels();
    return std::pair(*std::min_element(p.begin(), p.end()), *std::max_element(p.begin(), p.end()));
  };
  const std::vector<float> p = height->pixels();
  const float rise = *std::max_element(p.begin(), p.end()) - *std::min_element(p.begin(), p.end());
  for (const double sign : {1.0, -1.0}) {
    CHECK(range("normalized", sign * 3) == std::pair(0.0f, 1.0f));
    const auto [low, high] = range("from_zero", sign * 20);
    CHECK(low == 0);
    CHECK(high == doctest::Approx(rise / 2).epsilon(0.01));
  }
  const auto [low, high] = range("centered", 10);
  CHECK(high - low == doctest::Approx(rise).epsilon(0.01));
}

TEST_CASE("a flat normal map gives the middle, the bottom, the bottom") {
  const ImagePtr flat = flat_image({5, 4}, {0.5f, 0.5f, 1}, Semantic::normal);
  for (const float h : made(flat, {{"range", "centered"}})->pixels()) CHECK(h == 0.5f);
  for (const std::string range : {"from_zero", "normalized"})
    for (const float h : made(flat, {{"range", range}})->pixels()) CHECK(h == 0);
}

TEST_CASE("the note of a normalized map says its height_scale") {
  const ImagePtr height = bumps({48, 48}, 24);
  const ImagePtr normals = run_image("make_normal", {{"height_scale", 10.0}, {"edges", "wrap"}}, {{"height", height}});
  const NodeRun run = run_node("make_height", {{"range", "normalized"}, {"edges", "wrap"}}, {{"normal", {normals}}});
  CHECK(run.says("pixels tall, which is the height_scale of this map"));
}

TEST_CASE("make_height is the same on any number of threads") {
  for (const std::string edges : {"clamp", "wrap"})
    check_every_size([&](Size size) {
      return made(noise_image(size, 3, Semantic::normal), {{"edges", edges}, {"flatten", 30.0}});
    });
}

TEST_CASE("make_height wants normals") {
  CHECK(error_of("make_height", {}, {{"normal", flat_image({4, 2}, {0}, Semantic::height)}}, "normal")
            .find("expected a normal map of 3 channels, found a height map") != std::string::npos);
}

TEST_CASE("a height_scale of 0 is refused before anything runs") {
  const NodeType* type = find_node_type("make_height");
  CHECK(type->check({{"height_scale", 1.0}}).empty());
  CHECK(type->check({{"height_scale", 0.0}}).size() == 1);
}
