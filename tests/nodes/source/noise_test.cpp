#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "nodes/common/registry.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

ImagePtr noise(const Params& params) {
  return run_node("noise", params).get<Image>("image");
}

const std::vector<std::string>& choices(const std::string& param) {
  return find_node_type("noise")->find_param(param)->choices;
}

}  // namespace

TEST_CASE("every noise is in range, varied, and the same in any window") {
  for (const std::string& basis : choices("basis"))
    for (const std::string& fractal : choices("fractal")) {
      CAPTURE(basis);
      CAPTURE(fractal);
      const ImagePtr n = noise({{"basis", basis}, {"fractal", fractal}, {"size", Size{96, 64}}});
      const std::vector<float> all = n->pixels();
      const auto [low, high] = std::minmax_element(all.begin(), all.end());
      CHECK(*low >= 0);
      CHECK(*high <= 1);
      CHECK(*high - *low > 0.3);
      const Rect window{37, 11, 23, 30};
      const std::vector<float> part = n->read(window);
      bool same = true;
      for (int y = 0; y < window.height; y++)
        for (int x = 0; x < window.width; x++)
          same = same && part[size_t(y) * 23 + x] == all[size_t(window.y + y) * 96 + window.x + x];
      CHECK(same);
    }
}

TEST_CASE("a tileable noise is as smooth across its border as inside") {
  for (const std::string& basis : choices("basis")) {
    CAPTURE(basis);
    const ImagePtr n =
        noise({{"basis", basis}, {"size", Size{80, 48}}, {"tileable", true}, {"scale", 6.4}, {"octaves", int64_t{3}}});
    const std::vector<float> p = n->pixels();
    double inside = 0, across = 0, down = 0;
    for (int y = 0; y < 48; y++) {
      for (int x = 0; x + 1 < 80; x++)
        inside += std::abs(p[size_t(y) * 80 + x] - p[size_t(y) * 80 + x + 1]) / (79 * 48);
      across += std::abs(p[size_t(y) * 80] - p[size_t(y) * 80 + 79]) / 48;
    }
    for (int x = 0; x < 80; x++) down += std::abs(p[size_t(x)] - p[size_t(47) * 80 + x]) / 80;
    CHECK(across < 2 * inside);
    CHECK(down < 2 * inside);
  }
}

TEST_CASE("noise seeds, scales and meanings do what they say") {
  const Params small = {{"size", Size{32, 32}}};
  Params other = small;
  other["seed"] = int64_t{2};
  CHECK(noise(small)->pixels() == noise(small)->pixels());
  CHECK(noise(small)->pixels() != noise(other)->pixels());

  const auto roughness_of = [](double scale, const std::string& unit) {
    const std::vector<float> p =
        noise({{"size", Size{64, 64}}, {"scale", scale}, {"unit", unit}, {"octaves", int64_t{1}}})->pixels();
    double sum = 0;
    for (size_t i = 1; i < p.size(); i++) sum += std::abs(p[i] - p[i - 1]);
    return sum;
  };
  CHECK(roughness_of(16, "across") > 2 * roughness_of(4, "across"));
  CHECK(roughness_of(4, "across") == roughness_of(16, "pixels"));

  const ImageInfo info = noise({{"size", Size{8, 8}}, {"semantic", "roughness"}})->info();
  CHECK(info.semantic == Semantic::roughness);
  CHECK(info.color_space == "raw");
  CHECK(info.depth == Depth::u16);
  CHECK(noise({{"size", Size{1, 1}}})->pixels().size() == 1);
}

TEST_CASE("noise values survive a 16-bit file") {
  bool exact = true;
  for (const float v : noise({{"size", Size{32, 32}}})->pixels())
    exact = exact && v == float(std::lround(double(v) * 65535)) / 65535.0f;
  CHECK(exact);
}
