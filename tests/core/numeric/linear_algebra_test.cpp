#include "core/numeric/linear_algebra.h"

#include <stdexcept>

#include <doctest/doctest.h>

using namespace terrazzo;

TEST_CASE("the eigenvectors of a symmetric matrix make up the matrix again, largest eigenvalue first") {
  const int n = 4;
  const std::vector<double> matrix = {4, 1, -2, 2, 1, 2, 0, 1, -2, 0, 3, -2, 2, 1, -2, -1};
  const SymmetricEigen e = eigen_symmetric(matrix, n);
  for (int i = 1; i < n; i++) CHECK(e.values[i] <= e.values[i - 1]);
  for (int r = 0; r < n; r++)
    for (int c = 0; c < n; c++) {
      double sum = 0, product = 0;
      for (int i = 0; i < n; i++) {
        sum += e.values[i] * e.vectors[i * n + r] * e.vectors[i * n + c];
        product += e.vectors[r * n + i] * e.vectors[c * n + i];
      }
      CHECK(sum == doctest::Approx(matrix[r * n + c]).epsilon(1e-12));
      CHECK(product == doctest::Approx(r == c ? 1 : 0).epsilon(1e-12));
    }
}

TEST_CASE("an eigenvector's largest component is positive") {
  const SymmetricEigen e = eigen_symmetric({2, -1.5, -1.5, 1}, 2);
  CHECK(e.vectors[0] > 0.5);
  CHECK(e.vectors[3] > 0.5);
}

TEST_CASE("equations of a positive definite matrix are solved, others refused") {
  const std::vector<double> matrix = {4, 1, -2, 1, 3, 0.5, -2, 0.5, 5}, wanted = {1, -2, 3};
  std::vector<double> right;
  for (size_t i = 0; i < 3; i++)
    right.push_back(matrix[3 * i] * wanted[0] + matrix[3 * i + 1] * wanted[1] + matrix[3 * i + 2] * wanted[2]);
  const std::vector<double> x = solve_positive_definite(matrix, right);
  for (size_t i = 0; i < 3; i++) CHECK(x[i] == doctest::Approx(wanted[i]).epsilon(1e-12));
  CHECK_THROWS_AS(solve_positive_definite({1, 2, 2, 1}, {1, 1}), std::invalid_argument);
  CHECK_THROWS_AS(solve_positive_definite({1, 0, 0}, {1, 1}), std::invalid_argument);
}
