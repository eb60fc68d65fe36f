#include "core/numeric/nearest.h"

#include <doctest/doctest.h>

#include "core/base/hash.h"

using namespace terrazzo;

namespace {

constexpr int dimensions = 10;

std::vector<float> random_points(size_t count, uint64_t seed) {
  std::vector<float> out(count * dimensions);
  // Coarse values, so that some coordinates are equal.
  for (size_t i = 0; i < out.size(); i++) out[i] = float(random_bits(seed, i) % 64) / 8;
  return out;
}

float squared(const float* a, const float* b) {
  float sum = 0;
  for (int k = 0; k < dimensions; k++) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

float nearest_by_force(const std::vector<float>& points, const float* query, uint32_t except) {
  float best = 1e30f;
  for (uint32_t i = 0; i < points.size() / dimensions; i++)
    if (i != except) best = std::min(best, squared(&points[size_t(i) * dimensions], query));
  return best;
}

}  // namespace

TEST_CASE("without slack the nearest point is found, with slack one nearly as near") {
  const std::vector<float> points = random_points(1000, 1), queries = random_points(200, 2);
  const NearestPoints tree(points, dimensions);
  for (size_t i = 0; i < 200; i++) {
    const float* query = &queries[i * dimensions];
    const float truth = nearest_by_force(points, query, NearestPoints::nothing);
    const auto exact = tree.find(query, 0), near = tree.find(query, 0.3);
    CHECK(exact.squared == truth);
    CHECK(squared(&points[size_t(exact.index) * dimensions], query) == truth);
    CHECK(near.squared <= truth * 1.3f * 1.3f);
  }
}

TEST_CASE("a point can be left out of its own search") {
  const std::vector<float> points = random_points(300, 3);
  const NearestPoints tree(points, dimensions);
  for (uint32_t i = 0; i < 300; i++) {
    const float* query = &points[size_t(i) * dimensions];
    CHECK(tree.find(query, 0).squared == 0);
    CHECK(tree.find(query, 0, [&](uint32_t other) { return other == i; }).index != i);
    CHECK(tree.find(query, 0, [&](uint32_t other) { return other == i; }).squared ==
          nearest_by_force(points, query, i));
  }
}

TEST_CASE("among equal points the first is found") {
  const NearestPoints tree(std::vector<float>(100 * dimensions, 2.f), dimensions);
  const std::vector<float> query(dimensions, 1.f);
  CHECK(tree.find(query.data(), 0).index == 0);
  CHECK(tree.find(query.data(), 0, [](uint32_t other) { return other == 0; }).index == 1);
}
