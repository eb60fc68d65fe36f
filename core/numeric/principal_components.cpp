#include "core/numeric/principal_components.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "core/base/hash.h"
#include "core/numeric/linear_algebra.h"
#include "core/numeric/weighted_row_sum.h"

namespace terrazzo {

namespace {

/// The covariance matrix of centred samples, n x n. Each element is summed by one thread in sample order: in single
/// precision within a block, in double across blocks.
std::vector<double> covariance(const std::vector<float>& centred, int n, const Task& task) {
  const size_t count = centred.size() / n;
  std::vector<double> matrix(size_t(n) * n, 0.0);
  constexpr size_t block = 128;
  tbb::parallel_for(0, n, [&](int i) {
    task.check();
    std::vector<float> partial(n);
    double* row = &matrix[size_t(i) * n];
    for (size_t begin = 0; begin < count; begin += block) {
      std::fill(partial.begin() + i, partial.end(), 0.0f);
      const float* column = &centred[begin * n + i];
      weighted_row_sum(&partial[i], n - i, column, n, column, n, std::min(block, count - begin));
      for (int j = i; j < n; j++) row[j] += partial[j];
    }
  });
  for (int i = 0; i < n; i++)
    for (int j = i; j < n; j++) matrix[size_t(j) * n + i] = matrix[size_t(i) * n + j] /= double(count);
  return matrix;
}

double dot(const double* a, const double* b, int n) {
  double s = 0;
  for (int i = 0; i < n; i++) s += a[i] * b[i];
  return s;
}

/// Modified Gram-Schmidt on rows; a row that vanishes is replaced by a unit vector and made orthogonal in turn.
void orthonormalise(std::vector<double>& rows, int count, int n) {
  for (int r = 0; r < count; r++) {
    double* v = &rows[size_t(r) * n];
    for (int attempt = 0; attempt <= n; attempt++) {
      const double before = std::sqrt(dot(v, v, n));
      for (int q = 0; q < r; q++) {
        const double* u = &rows[size_t(q) * n];
        const double along = dot(u, v, n);
        for (int i = 0; i < n; i++) v[i] -= along * u[i];
      }
      const double length = std::sqrt(dot(v, v, n));
      if (length > 1e-9 * before && length > 1e-200) {
        for (int i = 0; i < n; i++) v[i] /= length;
        break;
      }
      std::fill(v, v + n, 0.0);
      v[(r + attempt) % n] = 1.0;
    }
  }
}

/// The products of an n x n matrix with m rows, as rows.
std::vector<double> products(const std::vector<double>& matrix, const std::vector<double>& rows, int m, int n) {
  // All rows at once, one number of each side by side: the sums of one row alone would wait for one another.
  std::vector<double> columns(rows.size()), out(rows.size());
  for (int r = 0; r < m; r++)
    for (int i = 0; i < n; i++) columns[size_t(i) * m + r] = rows[size_t(r) * n + i];
  tbb::parallel_for(0, n, [&](int i) {
    std::vector<double> sums(m, 0.0);
    for (int k = 0; k < n; k++)
      for (int r = 0; r < m; r++) sums[r] += matrix[size_t(i) * n + k] * columns[size_t(k) * m + r];
    for (int r = 0; r < m; r++) out[size_t(r) * n + i] = sums[r];
  });
  return out;
}

/// Turns the rows into Ritz vectors of `matrix` within their span, largest value first. Returns the values.
std::vector<double> rayleigh_ritz(const std::vector<double>& matrix, std::vector<double>& rows, int m, int n) {
  const std::vector<double> image = products(matrix, rows, m, n);
  std::vector<double> small(size_t(m) * m);
  for (int r = 0; r < m; r++)
    for (int q = 0; q <= r; q++)
      small[r * m + q] = small[q * m + r] = dot(&rows[size_t(r) * n], &image[size_t(q) * n], n);
  SymmetricEigen eigen = eigen_symmetric(std::move(small), m);
  std::vector<double> turned(size_t(m) * n, 0.0);
  for (int r = 0; r < m; r++)
    for (int q = 0; q < m; q++) {
      const double w = eigen.vectors[size_t(r) * m + q];
      for (int i = 0; i < n; i++) turned[size_t(r) * n + i] += w * rows[size_t(q) * n + i];
    }
  for (double& v : eigen.values) v = std::max(0.0, v);
  rows = std::move(turned);
  return eigen.values;
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
  const std::vector<double> matrix = covariance(centred, n, task);
  for (int i = 0; i < n; i++) out.total_variance += matrix[size_t(i) * n + i];

  // A few more rows than asked for: the gap beyond them is what sets the speed of convergence.
  const int m = std::min(n, count + 6);
  std::vector<double> rows(size_t(m) * n);
  for (size_t i = 0; i < rows.size(); i++) rows[i] = unit_double(random_bits(n, i)) - 0.5;
  orthonormalise(rows, m, n);
  for (int step = 0; step < 24; step++) {
    task.check();
    rows = products(matrix, rows, m, n);
    orthonormalise(rows, m, n);
  }
  const std::vector<double> values = rayleigh_ritz(matrix, rows, m, n);
  count = std::min(count, n);
  for (int r = 0; r < count; r++) {
    const double* v = &rows[size_t(r) * n];
    // The sign of an eigenvector is arbitrary: make the entry of largest size positive.
    const double* peak = std::max_element(v, v + n, [](double a, double b) { return std::abs(a) < std::abs(b); });
    const double sign = *peak < 0 ? -1 : 1;
    for (int i = 0; i < n; i++) out.components.push_back(float(sign * v[i]));
    out.variances.push_back(values[r]);
  }
  return out;
}

}  // namespace terrazzo
