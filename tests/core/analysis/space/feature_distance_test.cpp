#include "core/analysis/space/feature_distance.h"

#include <cmath>

#include <doctest/doctest.h>

#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {
ImagePtr box() {
  return make_image(
      {40, 40}, 1, [](int x, int y, int) { return x >= 12 && x < 28 && y >= 12 && y < 28 ? 0.9f : 0.1f; },
      Semantic::height);
}
}  // namespace

TEST_CASE("edges lie on the outline, and the distance grows away from it on both sides") {
  const Edges edges = find_edges(*Material::of(box()), {}, Task());
  CHECK(edges.mask[20 * 40 + 12] == 1);
  CHECK(edges.mask[20 * 40 + 20] == 0);
  CHECK(edges.mask[3 * 40 + 3] == 0);
  const ImagePtr distance = feature_distance(edges, {40, 40}, false, 5);
  CHECK(distance->info().semantic == Semantic::guidance);
  const std::vector<float> d = distance->pixels();
  CHECK(d[20 * 40 + 12] < 0);
  CHECK(d[20 * 40 + 20] > d[20 * 40 + 15]);
  CHECK(d[20 * 40 + 3] > d[20 * 40 + 8]);
  CHECK(d[0] == 5);
}

TEST_CASE("a given threshold is used, a lower one finds more") {
  const MaterialPtr material = Material::of(box());
  const auto count = [&](double threshold) {
    const Edges e = find_edges(*material, {.threshold = threshold}, Task());
    return std::count(e.mask.begin(), e.mask.end(), 1);
  };
  CHECK(count(0.1) > count(0.9));
}

TEST_CASE("an unknown map is refused with the known ones") {
  CHECK_THROWS_WITH_AS(find_edges(*Material::of(box()), {.maps = {"normal"}}, Task()),
                       "there is no map \"normal\"; the material has height", Error);
}

TEST_CASE("the guidance node gives a distance and its edges") {
  const NodeRun run = run_node("guidance", {}, {{"material", {box()}}});
  CHECK(run.get<Image>("distance")->size() == Size{40, 40});
  CHECK(run.get<Image>("edges")->info().semantic == Semantic::mask);
  CHECK(run.get<Image>("gradients")->channels() == 2);
}

TEST_CASE("there are no edges where the mask forbids, nor around it") {
  const ImagePtr open = make_image({40, 40}, 1, [](int x, int y, int) { return x < 20 || y < 20 ? 1.f : 0.f; });
  const ImagePtr flat = make_image(
      {40, 40}, 1, [](int x, int y, int) { return x < 20 || y < 20 ? float(x % 10 == 0) : 9.f; }, Semantic::height);
  const NodeRun run = run_node("guidance", {{"threshold", 0.3}}, {{"material", {flat}}, {"mask", {open}}});
  const std::vector<float> edges = run.get<Image>("edges")->pixels();
  for (int y = 20; y < 40; y++)
    for (int x = 20; x < 40; x++) CHECK(edges[y * 40 + x] == 0);
  CHECK(edges[19 * 40 + 36] == 0);
  CHECK(edges[25 * 40 + 10 + 1] == 1);
}

TEST_CASE("gradients point uphill, with opposite signs on opposite sides") {
  const Edges edges = find_edges(*Material::of(box()), {}, Task());
  const auto along_x = [&](int x, int y) { return edges.gradients[2 * size_t(y * 40 + x)]; };
  const auto along_y = [&](int x, int y) { return edges.gradients[2 * size_t(y * 40 + x) + 1]; };
  CHECK(along_x(12, 20) > 0.1f);
  CHECK(along_x(27, 20) == doctest::Approx(-along_x(12, 20)));
  CHECK(along_y(20, 12) > 0.1f);
  CHECK(along_y(20, 27) < -0.1f);
  CHECK(std::abs(along_y(12, 20)) < 1e-4f);
  CHECK(std::abs(along_x(20, 20)) < 1e-4f);
}
