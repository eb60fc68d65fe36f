#include "core/analysis/principal_components.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "core/hash.h"

namespace terrazzo {

namespace {

/// The covariance matrix of centred samples, n x n. Each element is summed by one thread in sample order: in single
/// precision within a block, in double across blocks.
std::vector<double> covariance(const std::vector<float>& centred, int n) {
  const size_t count = centred.size() / n;
  std::vector<double> matrix(size_t(n) * n, 0.0);
  constexpr size_t block = 128;
  tbb::parallel_for(0, n, [&](int i) {
    std::vector<float> partial(n);
    double* row = &matrix[size_t(i) * n];
    for (size_t begin = 0; begin < count; begin += block) {
      std::fill(partial.begin() + i, partial.end(), 0.0f);
      for (size_t s = begin; s < std::min(count, begin + block); s++) {
        const float* v = &centred[s * n];
        const float factor = v[i];
        for (int j = i; j < n; j++) partial[j] += factor * v[j];
      }
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

/// Eigenvectors of a small symmetric matrix by cyclic Jacobi rotations; `vectors` gets them as rows.
void jacobi(std::vector<double>& a, std::vector<double>& vectors, int m) {
  vectors.assign(size_t(m) * m, 0.0);
  for (int i = 0; i < m; i++) vectors[size_t(i) * m + i] = 1.0;
  for (int sweep = 0; sweep < 30; sweep++) {
    double off = 0, on = 0;
    for (int i = 0; i < m; i++)
      for (int j = 0; j < m; j++) (i == j ? on : off) += a[i * m + j] * a[i * m + j];
    if (off <= 1e-24 * on) break;
    for (int p = 0; p < m; p++)
      for (int q = p + 1; q < m; q++) {
        if (a[p * m + q] == 0) continue;
        const double theta = (a[q * m + q] - a[p * m + p]) / (2 * a[p * m + q]);
        const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (int k = 0; k < m; k++) {
          const double kp = a[k * m + p], kq = a[k * m + q];
          a[k * m + p] = c * kp - s * kq;
          a[k * m + q] = s * kp + c * kq;
        }
        for (int k = 0; k < m; k++) {
          const double pk = a[p * m + k], qk = a[q * m + k];
          a[p * m + k] = c * pk - s * qk;
          a[q * m + k] = s * pk + c * qk;
          const double vp = vectors[p * m + k], vq = vectors[q * m + k];
          vectors[p * m + k] = c * vp - s * vq;
          vectors[q * m + k] = s * vp + c * vq;
        }
      }
  }
}

/// Turns the rows into Ritz vectors of `matrix` within their span, largest value first. Returns the values.
std::vector<double> rayleigh_ritz(const std::vector<double>& matrix, std::vector<double>& rows, int m, int n) {
  std::vector<double> image(size_t(m) * n), small(size_t(m) * m), vectors;
  tbb::parallel_for(0, m, [&](int r) {
    for (int i = 0; i < n; i++) image[size_t(r) * n + i] = dot(&matrix[size_t(i) * n], &rows[size_t(r) * n], n);
  });
  for (int r = 0; r < m; r++)
    for (int q = 0; q <= r; q++)
      small[r * m + q] = small[q * m + r] = dot(&rows[size_t(r) * n], &image[size_t(q) * n], n);
  jacobi(small, vectors, m);
  std::vector<int> order(m);
  for (int i = 0; i < m; i++) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return small[a * m + a] > small[b * m + b]; });
  std::vector<double> turned(size_t(m) * n, 0.0), values;
  for (int r = 0; r < m; r++) {
    values.push_back(std::max(0.0, small[order[r] * m + order[r]]));
    for (int q = 0; q < m; q++) {
      const double w = vectors[size_t(order[r]) * m + q];
      for (int i = 0; i < n; i++) turned[size_t(r) * n + i] += w * rows[size_t(q) * n + i];
    }
  }
  rows = std::move(turned);
  return values;
}

}  // namespace

PrincipalComponents principal_components(const std::vector<float>& samples, int n, int count) {
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
  const std::vector<double> matrix = covariance(centred, n);
  for (int i = 0; i < n; i++) out.total_variance += matrix[size_t(i) * n + i];

  // A few more rows than asked for: the gap beyond them is what sets the speed of convergence.
  const int m = std::min(n, count + 6);
  std::vector<double> rows(size_t(m) * n), next(rows.size());
  for (size_t i = 0; i < rows.size(); i++) rows[i] = unit_double(random_bits(n, i)) - 0.5;
  orthonormalise(rows, m, n);
  for (int step = 0; step < 24; step++) {
    tbb::parallel_for(0, m, [&](int r) {
      for (int i = 0; i < n; i++) next[size_t(r) * n + i] = dot(&matrix[size_t(i) * n], &rows[size_t(r) * n], n);
    });
    rows.swap(next);
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
