#pragma once

#include <utility>
#include <vector>

namespace terrazzo {

/// A function through points, for remapping values. Constant before the first point and after the last. Immutable;
/// thread-safe.
class Curve {
 public:
  /// At least one point, x ascending strictly. `smooth`: cubic pieces whose slopes are the weighted harmonic means of
  /// those beside them, so that the curve rises and falls only where its points do (Fritsch & Butland, A method for
  /// constructing local monotone piecewise cubic interpolants, 1984); else straight lines.
  Curve(std::vector<std::pair<double, double>> points, bool smooth);

  double at(double x) const;

 private:
  std::vector<std::pair<double, double>> points_;
  std::vector<double> slopes_;  ///< at the points; empty: straight lines
};

}  // namespace terrazzo
