#include "core/numeric/linear_algebra.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace terrazzo {

namespace {

struct Rotation {
  double cosine, sine;
};

/// The rotation of axes p and q that makes their common element vanish.
Rotation annihilating(const std::vector<double>& a, int n, int p, int q) {
  const double theta = (a[q * n + q] - a[p * n + p]) / (2 * a[p * n + q]);
  const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1);
  return {c, t * c};
}

void rotate(double& first, double& second, const Rotation& r) {
  const double f = first, s = second;
  first = r.cosine * f - r.sine * s;
  second = r.sine * f + r.cosine * s;
}

bool is_diagonal(const std::vector<double>& a, int n) {
  double off = 0, on = 0;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) (i == j ? on : off) += a[i * n + j] * a[i * n + j];
  return off <= 1e-24 * on;
}

/// Makes `a` diagonal; the rows of `vectors` become its eigenvectors.
void diagonalise(std::vector<double>& a, std::vector<double>& vectors, int n) {
  constexpr int most_sweeps = 30;
  for (int sweep = 0; sweep < most_sweeps && !is_diagonal(a, n); sweep++)
    for (int p = 0; p < n; p++)
      for (int q = p + 1; q < n; q++) {
        if (a[p * n + q] == 0) continue;
        const Rotation r = annihilating(a, n, p, q);
        for (int k = 0; k < n; k++) rotate(a[k * n + p], a[k * n + q], r);
        for (int k = 0; k < n; k++) rotate(a[p * n + k], a[q * n + k], r);
        for (int k = 0; k < n; k++) rotate(vectors[p * n + k], vectors[q * n + k], r);
      }
}

}  // namespace

SymmetricEigen eigen_symmetric(std::vector<double> matrix, int n) {
  if (n < 1 || matrix.size() != size_t(n) * n) throw std::logic_error("a square matrix is needed");
  std::vector<double> vectors(matrix.size(), 0.0);
  for (int i = 0; i < n; i++) vectors[size_t(i) * n + i] = 1;
  diagonalise(matrix, vectors, n);
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return matrix[a * n + a] > matrix[b * n + b]; });
  SymmetricEigen result{n, {}, {}};
  for (const int row : order) {
    const double* v = &vectors[size_t(row) * n];
    const double* peak = std::max_element(v, v + n, [](double a, double b) { return std::abs(a) < std::abs(b); });
    const double sign = *peak < 0 ? -1 : 1;
    result.values.push_back(matrix[size_t(row) * n + row]);
    for (int i = 0; i < n; i++) result.vectors.push_back(sign * v[i]);
  }
  return result;
}

std::vector<double> solve_positive_definite(std::vector<double> matrix, std::vector<double> right) {
  const int n = int(right.size());
  if (matrix.size() != right.size() * right.size())
    throw std::invalid_argument("solve_positive_definite: a matrix of another size");
  const auto l = [&](int i, int j) -> double& { return matrix[size_t(i * n + j)]; };
  for (int j = 0; j < n; j++) {
    for (int k = 0; k < j; k++) l(j, j) -= l(j, k) * l(j, k);
    if (l(j, j) <= 0) throw std::invalid_argument("solve_positive_definite: the matrix is not positive definite");
    l(j, j) = std::sqrt(l(j, j));
    for (int i = j + 1; i < n; i++) {
      for (int k = 0; k < j; k++) l(i, j) -= l(i, k) * l(j, k);
      l(i, j) /= l(j, j);
    }
  }
  for (int i = 0; i < n; i++) {
    for (int k = 0; k < i; k++) right[size_t(i)] -= l(i, k) * right[size_t(k)];
    right[size_t(i)] /= l(i, i);
  }
  for (int i = n - 1; i >= 0; i--) {
    for (int k = i + 1; k < n; k++) right[size_t(i)] -= l(k, i) * right[size_t(k)];
    right[size_t(i)] /= l(i, i);
  }
  return right;
}

}  // namespace terrazzo
