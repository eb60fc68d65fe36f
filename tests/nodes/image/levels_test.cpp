#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "nodes/common/registry.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("levels by default change nothing") {
  const ImagePtr image = noise_image({17, 11}, 3, Semantic::base_color, "srgb_texture");
  CHECK(run_image("levels", {}, {{"image", image}})->pixels() == image->pixels());
}

TEST_CASE("levels map black, white and the middle") {
  const ImagePtr ramp = make_image({5, 1}, 1, [](int x, int, int) { return float(x) / 4; });
  const std::vector<float> p = run_image("levels",
                                         {{"in_black", Numbers{0.25}},
                                          {"in_white", Numbers{0.75}},
                                          {"gamma", Numbers{2.0}},
                                          {"out_black", Numbers{1.0}},
                                          {"out_white", Numbers{0.0}}},
                                         {{"image", ramp}})
                                   ->pixels();
  const std::vector<double> expected = {1, 1, 1 - std::sqrt(0.5), 0, 0};
  for (int i = 0; i < 5; i++) CHECK(p[i] == doctest::Approx(expected[i]));
}

TEST_CASE("levels invert: gloss becomes roughness and comes back exactly, at every step of 8 and 16 bits") {
  const Params inverting{{"out_black", Numbers{1.0}}, {"out_white", Numbers{0.0}}};
  for (const int steps : {255, 65535}) {
    const ImagePtr gloss =
        with_depth(make_image({steps + 1, 1}, 1, [&](int x, int, int) { return float(x) / float(steps); }),
                   steps == 255 ? Depth::u8 : Depth::u16);
    const ImagePtr roughness = run_image("levels", inverting, {{"image", gloss}});
    const std::vector<float> inverted = roughness->pixels(),
                             back = run_image("levels", inverting, {{"image", roughness}})->pixels();
    for (int i = 0; i <= steps; i++) {
      REQUIRE(std::lround(double(inverted[size_t(i)]) * steps) == steps - i);
      REQUIRE(std::lround(double(back[size_t(i)]) * steps) == i);
    }
  }
}

TEST_CASE("levels per channel leave coverage alone") {
  const ImagePtr image = flat_image({2, 2}, {0.5f, 0.5f, 0.5f, 0.25f}, Semantic::base_color, "srgb_texture");
  const std::vector<float> p =
      run_image("levels", {{"out_white", Numbers{1.0, 0.5, 0.0}}}, {{"image", image}})->pixels();
  CHECK(p[0] == 0.5f);
  CHECK(p[1] == 0.25f);
  CHECK(p[2] == 0.0f);
  CHECK(p[3] == 0.25f);
}

TEST_CASE("automatic levels stretch what is there to black and white") {
  const ImagePtr image = make_image({64, 64}, 2, [](int x, int, int c) { return 0.2f + float(x) / (c ? 630 : 126); });
  const auto extent = [](const ImagePtr& result, int channel) {
    const std::vector<float> p = result->pixels();
    float low = 9, high = -9;
    for (size_t i = channel; i < p.size(); i += 2) {
      low = std::min(low, p[i]);
      high = std::max(high, p[i]);
    }
    return std::pair(low, high);
  };
  const ImagePtr each = run_image("levels", {{"auto", "channel"}, {"clip", 0.0}}, {{"image", image}});
  CHECK(extent(each, 0) == std::pair(0.0f, 1.0f));
  CHECK(extent(each, 1) == std::pair(0.0f, 1.0f));
  const ImagePtr all = run_image("levels", {{"auto", "image"}, {"clip", 0.0}}, {{"image", image}});
  CHECK(extent(all, 0) == std::pair(0.0f, 1.0f));
  CHECK(extent(all, 1).second == doctest::Approx(0.2));
}

TEST_CASE("automatic levels leave a constant and say so") {
  const NodeRun run = run_node("levels", {{"auto", "image"}}, {{"image", {flat_image({3, 3}, {0.4f})}}});
  CHECK(run.get<Image>("image")->pixels().front() == 0.4f);
  REQUIRE(run.notes.size() == 1);
  CHECK(run.notes.front().find("only one value") != std::string::npos);
}

TEST_CASE("levels are the same in tiles and on any number of threads") {
  for (const std::string mode : {"off", "image", "channel"})
    check_every_size([&](Size size) {
      return run_image("levels", {{"auto", mode}, {"gamma", Numbers{1.7}}}, {{"image", noise_image(size, 3)}});
    });
}

TEST_CASE("levels refuse normals, equal black and white, and counts that do not fit") {
  const ImagePtr color = flat_image({2, 2}, {0, 0, 0}, Semantic::base_color);
  CHECK(error_of("levels", {}, {{"image", flat_image({2, 2}, {0, 0, 0}, Semantic::normal)}}, "image").find("vectors") !=
        std::string::npos);
  CHECK(error_of("levels", {{"in_white", Numbers{0.0}}}, {{"image", color}}, "in_white").find("found 0 for both") !=
        std::string::npos);
  CHECK(error_of("levels", {{"gamma", Numbers{1.0, 2.0}}}, {{"image", color}}, "gamma")
            .find("one for each of the image's channels except alpha, 3; found 2") != std::string::npos);
}

TEST_CASE("equal black and white, and values out of any reason, are found before anything runs") {
  const NodeType* type = find_node_type("levels");
  Params params;
  for (const Param& p : type->params) params[p.name] = *p.fallback;
  CHECK(type->check(params).empty());
  params["in_black"] = Numbers{0.25, 1.0, 0.5};
  REQUIRE(type->check(params).size() == 1);
  CHECK(type->check(params)[0] == "\"in_white\": expected a value other than in_black, found 1 for both");
  params["auto"] = "image";
  CHECK(type->check(params).empty());
  for (const auto& [node, param] : {std::pair("levels", "in_white"), std::pair("normalize", "high"),
                                    std::pair("normalize", "deviation"), std::pair("threshold", "value")}) {
    CHECK(find_node_type(node)->find_param(param)->max == 1e6);
    CHECK(find_node_type(node)->find_param(param)->min.has_value());
  }
}
