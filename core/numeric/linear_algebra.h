#pragma once

#include "core/numeric/eigen.h"

namespace terrazzo {

/// Eigenvalues, largest first, and their unit eigenvectors.
struct SymmetricEigen {
  VectorXd values;
  MatrixXd vectors;  ///< a column for each value; its component of largest size is positive
};

/// The eigendecomposition of a symmetric matrix, at least one row: Eigen's, in an order and with signs that do not
/// depend on the method. Throws Error if it holds something that is not a finite number. The same bits on every
/// machine. Thread-safe.
SymmetricEigen eigen_symmetric(const MatrixXd& matrix);

/// The x of matrix x = right, by Cholesky's decomposition. Throws invalid_argument unless the matrix is symmetric and
/// positive definite and has the vector's size. The same bits on every machine. Thread-safe.
VectorXd solve_positive_definite(const MatrixXd& matrix, const VectorXd& right);

}  // namespace terrazzo
