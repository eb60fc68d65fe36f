#include "core/numeric/linear_algebra.h"

#include <limits>
#include <stdexcept>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/base/hash.h"

using namespace terrazzo;

namespace {

MatrixXd symmetric(int n, uint64_t seed) {
  MatrixXd out(n, n);
  for (int i = 0; i < n; i++)
    for (int j = 0; j <= i; j++) out(i, j) = out(j, i) = unit_double(random_bits(seed, i, j)) - 0.5;
  return out;
}

}  // namespace

TEST_CASE("the eigenvectors of a symmetric matrix make up the matrix again, largest eigenvalue first") {
  for (const int n : {1, 2, 4, 60}) {
    CAPTURE(n);
    const MatrixXd matrix = symmetric(n, 1);
    const SymmetricEigen e = eigen_symmetric(matrix);
    for (int i = 1; i < n; i++) CHECK(e.values[i] <= e.values[i - 1]);
    const MatrixXd again = e.vectors.lazyProduct(e.values.asDiagonal() * MatrixXd(e.vectors.transpose()));
    CHECK((again - matrix).cwiseAbs().maxCoeff() < 1e-13 * n);
    const MatrixXd unit = e.vectors.transpose().lazyProduct(e.vectors);
    CHECK((unit - MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff() < 1e-13 * n);
  }
}

TEST_CASE("an eigenvector's largest component is positive") {
  for (const SymmetricEigen& e : {eigen_symmetric(symmetric(12, 2)), eigen_symmetric(-symmetric(12, 2))})
    for (int i = 0; i < 12; i++) CHECK(e.vectors.col(i).maxCoeff() == e.vectors.col(i).cwiseAbs().maxCoeff());
}

TEST_CASE("a matrix that holds no number has no eigenvectors, and says so") {
  MatrixXd matrix = symmetric(5, 3);
  matrix(3, 1) = matrix(1, 3) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(eigen_symmetric(matrix), Error);
}

TEST_CASE("equations of a positive definite matrix are solved, others refused") {
  for (const int n : {1, 3, 17}) {
    const MatrixXd root = symmetric(n, 4) + MatrixXd::Identity(n, n);
    const MatrixXd matrix = root.lazyProduct(root.transpose());
    const VectorXd wanted = VectorXd::LinSpaced(n, -2, 3);
    CHECK((solve_positive_definite(matrix, matrix * wanted) - wanted).cwiseAbs().maxCoeff() < 1e-9);
  }
  MatrixXd indefinite(2, 2);
  indefinite << 1, 2, 2, 1;
  CHECK_THROWS_AS(solve_positive_definite(indefinite, VectorXd::Ones(2)), std::invalid_argument);
  CHECK_THROWS_AS(solve_positive_definite(MatrixXd::Identity(3, 3), VectorXd::Ones(2)), std::invalid_argument);
}
