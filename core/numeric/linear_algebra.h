#pragma once

#include <vector>

namespace terrazzo {

/// Eigenvalues, largest first, and their unit eigenvectors.
struct SymmetricEigen {
  int n = 0;
  std::vector<double> values;   ///< n
  std::vector<double> vectors;  ///< n rows of n; row i belongs to values[i], its largest component is positive
};

/// The eigendecomposition of a symmetric matrix of n rows, by cyclic Jacobi rotations (Golub & Van Loan, Matrix
/// Computations, section 8.5): for small matrices, tens of rows. The same bits on every machine. Thread-safe.
SymmetricEigen eigen_symmetric(std::vector<double> matrix, int n);

/// The x of matrix x = right, by Cholesky's decomposition (Golub & Van Loan, section 4.2): the matrix must be symmetric
/// and positive definite. The same bits on every machine. Thread-safe.
std::vector<double> solve_positive_definite(std::vector<double> matrix, std::vector<double> right);

}  // namespace terrazzo
