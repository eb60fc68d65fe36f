#pragma once

#include <cstddef>
#include <vector>

namespace terrazzo {

/// Adds `count` rows of `length` numbers, each times its factor, to the sums, one row after the other. `row_stride` and
/// `factor_stride`: from one to the next. The sums must be apart from both.
void add_products(float* sums, int length, const float* rows, size_t row_stride, const float* factors,
                  size_t factor_stride, size_t count);

/// Eigenvalues, largest first, and their unit eigenvectors.
struct SymmetricEigen {
  int n = 0;
  std::vector<double> values;   ///< n
  std::vector<double> vectors;  ///< n rows of n; row i belongs to values[i], its largest component is positive
};

/// The eigendecomposition of a symmetric matrix of n rows, by cyclic Jacobi rotations (Golub & Van Loan, Matrix
/// Computations, section 8.5): for small matrices, tens of rows. The same bits on every machine. Thread-safe.
SymmetricEigen eigen_symmetric(std::vector<double> matrix, int n);

}  // namespace terrazzo
