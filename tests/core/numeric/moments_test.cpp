#include "core/numeric/moments.h"

#include <array>
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "core/base/hash.h"
#include "core/numeric/gaussian.h"

using namespace terrazzo;

TEST_CASE("moments are those of the definition") {
  std::vector<std::array<float, 3>> vectors;
  for (int i = 0; i < 500; i++) {
    const auto a = float(unit_double(random_bits(1, i))), b = float(unit_double(random_bits(2, i)));
    vectors.push_back({a, b - 2 * a, 3 + b * b});
  }
  Moments<> dynamic(3);
  Moments<3> fixed;
  for (const auto& v : vectors) {
    dynamic.add(v.data());
    fixed.add(v.data());
  }
  CHECK(dynamic.count() == 500);
  Vector3d mean;
  for (const auto& v : vectors) mean += Vector3d(v[0], v[1], v[2]) / 500;
  CHECK((dynamic.mean_vector() - mean).norm() < 1e-12);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      double covariance = 0;
      for (const auto& v : vectors) covariance += (v[i] - mean[i]) * (v[j] - mean[j]) / 500;
      CHECK(dynamic.covariance(i, j) == doctest::Approx(covariance).epsilon(1e-9));
      CHECK(dynamic.covariance_matrix()(i, j) == dynamic.covariance(i, j));
      CHECK(fixed.covariance(i, j) == dynamic.covariance(i, j));
    }
}

TEST_CASE("of nothing all moments are 0, and equal numbers have no variance") {
  Moments<1> m;
  CHECK(m.count() == 0);
  CHECK(m.mean() == 0);
  CHECK(m.variance() == 0);
  for (int i = 0; i < 9; i++) m.add(0.1);
  CHECK(m.mean() == doctest::Approx(0.1));
  CHECK(m.variance() >= 0);
  CHECK(m.variance() < 1e-16);
}

TEST_CASE("a Gaussian's weights sum to 1 and fall as its formula says") {
  const std::vector<float> kernel = gaussian_kernel(1.7, 6);
  REQUIRE(kernel.size() == 13);
  double sum = 0;
  for (int i = 0; i <= 12; i++) {
    sum += double(kernel[size_t(i)]);
    CHECK(kernel[size_t(i)] == kernel[size_t(12 - i)]);
    CHECK(double(kernel[size_t(i)]) / double(kernel[6]) ==
          doctest::Approx(std::exp(-(i - 6) * (i - 6) / (2 * 1.7 * 1.7))).epsilon(1e-6));
  }
  CHECK(sum == doctest::Approx(1));
}
