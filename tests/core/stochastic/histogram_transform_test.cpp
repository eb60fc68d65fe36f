#include "core/stochastic/histogram_transform.h"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "core/base/hash.h"
#include "core/numeric/gaussian.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

Distribution distribution_of(Size size, const std::function<float(int i)>& value) {
  return Distribution::of(*make_image(size, 1, [&](int x, int y, int) { return value(y * size.width + x); }), Task())
      .front();
}

double random(int which, int i) {
  return unit_double(random_bits(uint64_t(which), i));
}

}  // namespace

TEST_CASE("values of any distribution become Gaussian and come back") {
  const auto skewed = [](int i) { return float(1000 + std::pow(random(1, i), 2)); };
  const HistogramTransform transform(distribution_of({128, 128}, skewed));
  double sum = 0, squares = 0, cubes = 0;
  for (int i = 0; i < 128 * 128; i++) {
    const double g = transform.to_gaussian(skewed(i));
    sum += g;
    squares += g * g;
    cubes += g * g * g;
    REQUIRE(transform.to_value(g) == doctest::Approx(skewed(i)).epsilon(2e-6));
  }
  const double count = 128 * 128;
  CHECK(std::abs(sum / count) < 1e-6);
  CHECK(squares / count == doctest::Approx(1).epsilon(1e-6));
  CHECK(std::abs(cubes / count) < 0.02);
}

TEST_CASE("Gaussian numbers become the values of the distribution, each as often as there") {
  const auto three = [](int i) { return i % 10 == 0 ? 0.7f : i % 10 < 4 ? 0.2f : 0.1f; };
  const HistogramTransform transform(distribution_of({100, 100}, three));
  std::map<float, int> counts;
  for (int i = 0; i < 10000; i++) counts[float(transform.to_value(normal_quantile((i + 0.5) / 10000)))]++;
  CHECK(counts[0.7f] == doctest::Approx(1000).epsilon(0.02));
  CHECK(counts[0.2f] == doctest::Approx(3000).epsilon(0.02));
  CHECK(counts[0.1f] == doctest::Approx(6000).epsilon(0.02));
}

TEST_CASE("one value stays that value") {
  const HistogramTransform transform(distribution_of({4, 4}, [](int) { return 0.3f; }));
  CHECK(transform.to_gaussian(0.3f) == 0);
  for (const double g : {-9.0, 0.0, 1.5, 9.0}) CHECK(float(transform.to_value(g)) == 0.3f);
  const PiecewiseLinear one = restoring_curve(distribution_of({4, 4}, [](int i) { return float(i); }),
                                              distribution_of({4, 4}, [](int) { return 0.3f; }));
  for (const double v : {-1.0, 3.0, 99.0}) CHECK(float(one(v)) == 0.3f);
}

TEST_CASE("a curve that restores a histogram gives each value as often as it is wanted") {
  const Distribution from = distribution_of({256, 256}, [](int i) { return float(random(1, i) + random(2, i)); });
  const PiecewiseLinear to_two =
      restoring_curve(from, distribution_of({10, 10}, [](int i) { return i < 80 ? -1.f : 3.f; }));
  int low = 0, between = 0;
  for (int i = 0; i < 65536; i++) {
    const double v = to_two(float(random(1, i) + random(2, i)));
    low += v == -1;
    between += v != -1 && v != 3;
  }
  CHECK(low == doctest::Approx(0.8 * 65536).epsilon(0.02));
  CHECK(between < 0.03 * 65536);
}

TEST_CASE("a value that most pixels have stays what it is, however near the others are") {
  const auto mostly = [](int i) { return i % 4 != 0 ? 0.25f : float(random(3, i)); };
  const PiecewiseLinear same =
      restoring_curve(distribution_of({256, 256}, mostly), distribution_of({256, 256}, mostly));
  CHECK(same(0.25f) == 0.25f);
  for (const double v : {0.1, 0.5, 0.9}) CHECK(same(v) == doctest::Approx(v).epsilon(0.02));
  CHECK(same(-1) == doctest::Approx(0).epsilon(0.001));
  CHECK(same(2) == doctest::Approx(1).epsilon(0.001));
}

TEST_CASE("a lookup table is linear in between and constant outside") {
  const LookupTable table(-1, 3, 4, [](double x) { return x * x; });
  CHECK(table(-7) == 1);
  CHECK(table(-1) == 1);
  CHECK(table(1.5) == doctest::Approx(2.5));
  CHECK(table(3) == 9);
  CHECK(table(50) == 9);
}
