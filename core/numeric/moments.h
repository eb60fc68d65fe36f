#pragma once

#include <algorithm>
#include <cstdint>

#include "core/numeric/eigen.h"

namespace terrazzo {

/// Accumulates the mean and covariance of vectors of n numbers, as sums of values and products in double, in the order
/// of calls. Unsuitable if the mean exceeds the deviation by many orders of magnitude.
template <int n = Eigen::Dynamic>
class Moments {
 public:
  using Vector = Eigen::Matrix<double, n, 1>;
  using Matrix = Eigen::Matrix<double, n, n>;

  Moments() requires(n != Eigen::Dynamic) = default;
  explicit Moments(int dimensions) requires(n == Eigen::Dynamic)
      : sum_(Vector::Zero(dimensions)), products_(Matrix::Zero(dimensions, dimensions)) {}

  /// Adds a vector of n floats or doubles.
  template <typename T>
  void add(const T* values) {
    count_++;
    for (int i = 0; i < sum_.size(); i++) {
      const auto v = double(values[i]);
      sum_[i] += v;
      for (int j = 0; j <= i; j++) products_(j, i) += v * double(values[j]);
    }
  }
  void add(double value) requires(n == 1) { add(&value); }

  int64_t count() const { return count_; }
  /// This and all following results are 0 if nothing was added.
  double mean(int i = 0) const { return sum_[i] / divisor(); }
  double covariance(int i, int j) const {
    return products_(std::min(i, j), std::max(i, j)) / divisor() - mean(i) * mean(j);
  }
  /// The population variance.
  double variance(int i = 0) const { return std::max(0.0, covariance(i, i)); }

  Vector mean_vector() const { return sum_ / divisor(); }
  Matrix covariance_matrix() const {
    Matrix out = products_;
    for (int i = 0; i < sum_.size(); i++)
      for (int j = 0; j <= i; j++) out(i, j) = out(j, i) = covariance(i, j);
    return out;
  }

 private:
  double divisor() const { return double(std::max<int64_t>(1, count_)); }
  int64_t count_ = 0;
  Vector sum_;
  Matrix products_;  ///< above and on the diagonal
};

}  // namespace terrazzo
