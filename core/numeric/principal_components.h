#pragma once

#include <vector>

#include "core/base/task.h"

namespace terrazzo {

/// The leading principal components of a set of vectors.
struct PrincipalComponents {
  std::vector<float> mean;        ///< length n
  std::vector<float> components;  ///< count rows of n, orthonormal, largest variance first, sign fixed
  std::vector<double> variances;  ///< count, descending
  double total_variance = 0;
};

/// Computes the `count` leading components of vectors of length n from their covariance matrix. `samples` holds the
/// vectors one after the other. Arithmetic is done in one fixed order, so the result has the same bits on every machine
/// and thread count. Throws Error if a sample is not finite, Cancelled.
PrincipalComponents principal_components(const std::vector<float>& samples, int n, int count, const Task& task = {});

}  // namespace terrazzo
