#pragma once

#include <utility>
#include <vector>

namespace terrazzo {

/// A function through points, for remapping values. Constant before the first point and after the last. Immutable;
/// thread-safe.
class Curve {
 public:
  /// Needs at least one point, with strictly ascending x. `smooth`: a monotone piecewise cubic, whose slopes are
  /// weighted harmonic means of the adjacent secants (Fritsch & Butland, A method for constructing local monotone
  /// piecewise cubic interpolants, 1984); else piecewise linear.
  Curve(std::vector<std::pair<double, double>> points, bool smooth);

  double at(double x) const;

 private:
  std::vector<std::pair<double, double>> points_;
  std::vector<double> slopes_;  ///< at the points; empty: straight lines
};

}  // namespace terrazzo
