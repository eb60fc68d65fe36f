#define EIGEN_DONT_VECTORIZE
#include "core/linear_algebra.h"

#include <cmath>
#include <stdexcept>

#include <Eigen/Eigenvalues>

namespace terrazzo {

SymmetricEigen eigen_symmetric(const std::vector<double>& matrix, int n) {
  if (n < 1 || matrix.size() != size_t(n) * n) throw std::logic_error("a square matrix is needed");
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(Eigen::Map<const Matrix>(matrix.data(), n, n));
  if (solver.info() != Eigen::Success) throw std::runtime_error("the eigenvalues of a matrix did not converge");
  SymmetricEigen result{n, std::vector<double>(n), std::vector<double>(matrix.size())};
  for (int i = 0; i < n; i++) {
    const auto column = solver.eigenvectors().col(n - 1 - i);
    int largest = 0;
    for (int j = 1; j < n; j++)
      if (std::abs(column[j]) > std::abs(column[largest])) largest = j;
    const double sign = column[largest] < 0 ? -1 : 1;
    result.values[i] = solver.eigenvalues()[n - 1 - i];
    for (int j = 0; j < n; j++) result.vectors[size_t(i) * n + j] = sign * column[j];
  }
  return result;
}

}  // namespace terrazzo
