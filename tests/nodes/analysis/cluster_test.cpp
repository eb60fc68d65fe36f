#include <algorithm>
#include <set>

#include <doctest/doctest.h>

#include "core/analysis/space/clusters.h"
#include "core/base/error.h"
#include "tests/exemplars.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

int region(int x, int y) {
  return y < 10 ? 2 : x < 25 ? 0 : 1;
}

/// Three regions of different colour under noise; region 0 is the darkest, 2 the lightest.
ImagePtr regions() {
  return make_image(
      {40, 30}, 3,
      [](int x, int y, int c) {
        constexpr float shades[3][3] = {{0.2f, 0.3f, 0.2f}, {0.6f, 0.3f, 0.3f}, {0.8f, 0.8f, 0.9f}};
        return shades[region(x, y)][c] + 0.1f * float(unit_double(random_bits(3, x, y, c)));
      },
      Semantic::base_color, "srgb_texture");
}

NodeRun clustered(const ImagePtr& image, int k, int seed = 1) {
  return run_node("cluster", {{"k", int64_t{k}}, {"seed", int64_t{seed}}}, {{"images", {image}}});
}

}  // namespace

TEST_CASE("cluster recovers three regions under noise exactly, dark to light, whatever the seed") {
  for (int seed = 1; seed <= 8; seed++) {
    const NodeRun run = clustered(regions(), 3, seed);
    const std::vector<float> labels = run.get<Image>("labels")->pixels();
    for (int y = 0; y < 30; y++)
      for (int x = 0; x < 40; x++) REQUIRE(labels[size_t(y * 40 + x)] == 0.5f * float(region(x, y)));
    CHECK(run.notes.front() == "3 clusters: 41.7 % 25.0 % 33.3 %");
  }
}

TEST_CASE("each pixel belongs to the nearest centre, and centres are the means of their pixels") {
  const ImagePtr image = noise_image({40, 30}, 3);
  const Planes planes = *weighted_planes(*plain_features(image), {});
  const Clusters c = find_clusters(planes, {.count = 7, .iterations = 1000}, {});
  REQUIRE(c.count == 7);
  std::vector<double> sums(21, 0.0), counts(7, 0.0);
  for (size_t i = 0; i < c.labels.size(); i++) {
    const auto distance = [&](size_t k) {
      double sum = 0;
      for (size_t d = 0; d < 3; d++)
        sum += (double(planes.values[3 * i + d]) - c.centres[3 * k + d]) *
               (double(planes.values[3 * i + d]) - c.centres[3 * k + d]);
      return std::sqrt(sum);
    };
    for (size_t k = 0; k < 7; k++) REQUIRE(distance(c.labels[i]) <= distance(k));
    REQUIRE(double(c.distances[i]) == doctest::Approx(distance(c.labels[i])));
    counts[c.labels[i]]++;
    for (size_t d = 0; d < 3; d++) sums[3 * c.labels[i] + d] += double(planes.values[3 * i + d]);
  }
  for (size_t i = 0; i < 21; i++) CHECK(sums[i] / counts[i / 3] == doctest::Approx(c.centres[i]).epsilon(1e-9));
  for (size_t k = 1; k < 7; k++) CHECK(c.centres[3 * k] > c.centres[3 * k - 3]);
}

TEST_CASE("where there are fewer values than clusters asked for, there are fewer clusters") {
  const ImagePtr two = make_image({8, 8}, 1, [](int x, int, int) { return x < 3 ? 0.f : 1.f; });
  const NodeRun run = clustered(two, 5);
  CHECK(run.notes.front() == "2 clusters: 37.5 % 62.5 %");
  CHECK(run.get<Image>("labels")->read({2, 0, 2, 1}) == std::vector<float>{0, 1});
  for (const float d : run.get<Image>("distance")->pixels()) CHECK(d == doctest::Approx(0));
  const std::vector<float> one = clustered(flat_image({4, 4}, {0.5f}), 3).get<Image>("labels")->pixels();
  CHECK(std::set<float>(one.begin(), one.end()) == std::set<float>{0});
}

TEST_CASE("cluster takes features and images together and says what does not fit") {
  const ImagePtr left = make_image({16, 16}, 1, [](int x, int, int) { return x < 8 ? 0.f : 1.f; });
  const ImagePtr top = make_image({16, 16}, 1, [](int, int y, int) { return y < 8 ? 0.f : 1.f; });
  const std::vector<float> labels =
      run_node("cluster", {{"k", int64_t{4}}}, {{"features", {plain_features(left)}}, {"images", {top}}})
          .get<Image>("labels")
          ->pixels();
  CHECK(std::set<float>(labels.begin(), labels.end()).size() == 4);
  CHECK_THROWS_WITH_AS(run_node("cluster"), doctest::Contains("connect \"features\" or \"images\""), Error);
  CHECK_THROWS_WITH_AS(
      run_node("cluster", {}, {{"features", {plain_features(left)}}, {"images", {flat_image({8, 16}, {1})}}}),
      doctest::Contains("expected 16x16, the size of the features; found a data map of 8x16"), Error);
}

TEST_CASE("smoothing calms the regions") {
  const ImagePtr noisy = make_image(
      {48, 48}, 1, [](int x, int y, int) { return (x < 24 ? 0.f : 0.4f) + float(unit_double(random_bits(7, x, y))); });
  const auto wrong = [&](double smoothing) {
    const std::vector<float> labels =
        run_node("cluster", {{"k", int64_t{2}}, {"smoothing", smoothing}}, {{"images", {noisy}}})
            .get<Image>("labels")
            ->pixels();
    int count = 0;
    for (int i = 0; i < 48 * 48; i++) count += (labels[size_t(i)] > 0.5f) != (i % 48 >= 24);
    return count;
  };
  CHECK(wrong(0) > 400);
  CHECK(wrong(4) < 100);
}

TEST_CASE("cluster is the same on any number of threads") {
  check_every_size([](Size size) { return clustered(noise_image(size, 2), 5).get<Image>("distance"); });
}
