#include "core/numeric/linear_algebra.h"

#include <mutex>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "core/base/error.h"

namespace terrazzo {

namespace {

/// Large products within decompositions are summed in blocks that fit these caches, whatever the machine has.
void fix_cache_sizes() {
  static std::once_flag once;
  std::call_once(once, [] { Eigen::setCpuCacheSizes(32 << 10, 512 << 10, 4 << 20); });
}

}  // namespace

SymmetricEigen eigen_symmetric(const MatrixXd& matrix) {
  if (matrix.rows() < 1 || matrix.rows() != matrix.cols()) throw std::logic_error("a square matrix is needed");
  fix_cache_sizes();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(matrix);
  if (solver.info() != Eigen::Success) throw Error("the maps hold infinite or NaN values");
  SymmetricEigen out{solver.eigenvalues().reverse(), solver.eigenvectors().rowwise().reverse()};
  for (auto vector : out.vectors.colwise()) {
    Eigen::Index peak = 0;
    vector.cwiseAbs().maxCoeff(&peak);
    if (vector[peak] < 0) vector = -vector;
  }
  return out;
}

VectorXd solve_positive_definite(const MatrixXd& matrix, const VectorXd& right) {
  if (matrix.rows() != right.size() || matrix.cols() != right.size())
    throw std::invalid_argument("solve_positive_definite: a matrix of another size");
  fix_cache_sizes();
  const Eigen::LLT<MatrixXd> cholesky(matrix);
  if (cholesky.info() != Eigen::Success)
    throw std::invalid_argument("solve_positive_definite: the matrix is not positive definite");
  return cholesky.solve(right);
}

}  // namespace terrazzo
