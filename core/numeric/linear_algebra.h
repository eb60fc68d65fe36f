#pragma once

#include "core/numeric/eigen.h"

namespace terrazzo {

/// Eigenvalues, largest first, and their unit eigenvectors.
struct SymmetricEigen {
  VectorXd values;
  MatrixXd vectors;  ///< a column for each value; its component of largest size is positive
};

/// The eigendecomposition of a symmetric matrix with at least one row, by Eigen, with normalised order and signs.
/// Throws Error if a value is not finite. Bit-exact on every machine. Thread-safe.
SymmetricEigen eigen_symmetric(const MatrixXd& matrix);

/// Solves matrix * x = right by Cholesky decomposition. Throws invalid_argument unless the matrix is symmetric and
/// positive definite and has the vector's size. The same bits on every machine. Thread-safe.
VectorXd solve_positive_definite(const MatrixXd& matrix, const VectorXd& right);

}  // namespace terrazzo
