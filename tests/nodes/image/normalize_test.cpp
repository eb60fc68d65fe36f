#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "core/image/normal.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("normalize stretches to the range asked for") {
  const ImagePtr image = make_image({6, 6}, 1, [](int x, int y, int) { return 3.0f + float(x * y); });
  const std::vector<float> p = run_image("normalize", {{"low", 0.25}, {"high", 0.75}}, {{"image", image}})->pixels();
  CHECK(*std::min_element(p.begin(), p.end()) == doctest::Approx(0.25));
  CHECK(*std::max_element(p.begin(), p.end()) == doctest::Approx(0.75));
}

TEST_CASE("normalize gives the mean and deviation asked for") {
  const std::vector<float> p = run_image("normalize", {{"mode", "statistics"}, {"mean", 2.0}, {"deviation", 0.5}},
                                         {{"image", noise_image({32, 32}, 1)}})
                                   ->pixels();
  double sum = 0, squares = 0;
  for (const float v : p) sum += v;
  const double mean = sum / double(p.size());
  for (const float v : p) squares += (v - mean) * (v - mean);
  CHECK(mean == doctest::Approx(2));
  CHECK(std::sqrt(squares / double(p.size())) == doctest::Approx(0.5));
}

TEST_CASE("normalize stretches channels together or each by itself") {
  const ImagePtr image = make_image({4, 1}, 2, [](int x, int, int c) { return float(x) * (c ? 1.0f : 2.0f); });
  CHECK(run_image("normalize", {}, {{"image", image}})->pixels()[7] == doctest::Approx(0.5));
  CHECK(run_image("normalize", {{"together", false}}, {{"image", image}})->pixels()[7] == doctest::Approx(1));
}

TEST_CASE("a constant takes the middle of the range, or the mean") {
  const ImagePtr flat = flat_image({3, 3}, {0.9f});
  CHECK(run_image("normalize", {}, {{"image", flat}})->pixels().front() == 0.5f);
  CHECK(run_image("normalize", {{"mode", "statistics"}, {"mean", 0.25}}, {{"image", flat}})->pixels().front() == 0.25f);
}

TEST_CASE("normalize makes normals unit length and keeps their direction") {
  const ImagePtr image = flat_image({2, 2}, {0.5f + 0.15f, 0.5f, 0.5f + 0.2f}, Semantic::normal);
  const std::vector<float> p = run_image("normalize", {}, {{"image", image}})->pixels();
  const Vector3f n = decode_normal(p.data(), NormalY::up);
  CHECK(n[0] == doctest::Approx(0.6));
  CHECK(n[1] == doctest::Approx(0));
  CHECK(n[2] == doctest::Approx(0.8));
}

TEST_CASE("normalize is the same in tiles and on any number of threads") {
  for (const std::string mode : {"range", "statistics"})
    for (const Semantic semantic : {Semantic::data, Semantic::normal})
      check_every_size([&](Size size) {
        return run_image("normalize", {{"mode", mode}}, {{"image", noise_image(size, 3, semantic)}});
      });
}
