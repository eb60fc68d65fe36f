#include "core/numeric/principal_components.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "core/numeric/linear_algebra.h"
#include "core/numeric/weighted_row_sum.h"

namespace terrazzo {

namespace {

/// The covariance matrix of centred samples. Each element is summed by one thread in sample order: in single precision
/// within a block, in double across blocks.
MatrixXd covariance(const std::vector<float>& centred, int n, const Task& task) {
  const size_t count = centred.size() / n;
  MatrixXd matrix = MatrixXd::Zero(n, n);
  constexpr size_t block = 128;
  tbb::parallel_for(0, n, [&](int i) {
    task.check();
    std::vector<float> partial(n);
    double* column = matrix.col(i).data();
    for (size_t begin = 0; begin < count; begin += block) {
      std::fill(partial.begin() + i, partial.end(), 0.0f);
      const float* values = &centred[begin * n + i];
      weighted_row_sum(&partial[i], n - i, values, n, values, n, std::min(block, count - begin));
      for (int j = i; j < n; j++) column[j] += partial[j];
    }
  });
  matrix /= double(count);
  return matrix.selfadjointView<Eigen::Lower>();
}

}  // namespace

PrincipalComponents principal_components(const std::vector<float>& samples, int n, int count, const Task& task) {
  const size_t total = samples.size() / n;
  PrincipalComponents out;
  std::vector<double> mean(n, 0.0);
  for (size_t s = 0; s < total; s++)
    for (int i = 0; i < n; i++) mean[i] += samples[s * n + i];
  for (double& v : mean) v /= double(std::max<size_t>(1, total));
  out.mean.assign(mean.begin(), mean.end());
  std::vector<float> centred(samples.size());
  for (size_t s = 0; s < total; s++)
    for (int i = 0; i < n; i++) centred[s * n + i] = samples[s * n + i] - out.mean[i];
  const MatrixXd matrix = covariance(centred, n, task);
  out.total_variance = matrix.trace();
  task.check();
  const SymmetricEigen axes = eigen_symmetric(matrix);
  for (int r = 0; r < std::min(count, n); r++) {
    out.components.insert(out.components.end(), axes.vectors.col(r).begin(), axes.vectors.col(r).end());
    out.variances.push_back(std::max(0.0, axes.values[r]));
  }
  return out;
}

}  // namespace terrazzo
