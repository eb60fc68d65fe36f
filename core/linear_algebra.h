#pragma once

#include <vector>

namespace terrazzo {

/// Eigenvalues, largest first, and their unit eigenvectors.
struct SymmetricEigen {
  int n = 0;
  std::vector<double> values;   ///< n
  std::vector<double> vectors;  ///< n rows of n; row i belongs to values[i], its largest component is positive
};

/// The eigendecomposition of a symmetric matrix of n rows (only the lower triangle is read). In plain scalar
/// arithmetic, so that the bits are the same on every machine. Thread-safe.
SymmetricEigen eigen_symmetric(const std::vector<double>& matrix, int n);

}  // namespace terrazzo
