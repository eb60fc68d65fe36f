#pragma once

#include <functional>
#include <vector>

#include "core/image/distribution.h"

namespace terrazzo {

/// The value at each rank in [0, 1] of a distribution whose sorted pixels are joined by straight lines: unlike
/// Distribution::quantile it gives every value as often as it occurs, so that a map of two values keeps its hard edges.
PiecewiseLinear sorted_pixels(const Distribution& distribution);

/// A function sampled evenly over [low, high]: linear in between and constant outside. Immutable; thread-safe.
class LookupTable {
 public:
  LookupTable(double low, double high, int intervals, const std::function<double(double)>& function);
  double operator()(double x) const;

 private:
  double low_, scale_;
  std::vector<float> values_;
};

/// The histogram transformation (Heitz & Neyret 2018): from the values of a distribution to a Gaussian one of mean 0
/// and variance 1 by rank, and back. Equal values go to one: what few values hold becomes as nearly Gaussian as it can.
/// Immutable; thread-safe; the same on every machine.
class HistogramTransform {
 public:
  explicit HistogramTransform(const Distribution& values);
  double to_gaussian(double value) const { return forward_(value); }
  double to_value(double gaussian) const { return back_(gaussian); }

 private:
  PiecewiseLinear forward_;
  LookupTable back_;
};

/// The curve that gives values distributed like `from`, a sample, the distribution `to`, every value of it as often as
/// it occurs there. Smooth over a thousandth of the sample, but for values that occur more often in it.
PiecewiseLinear restoring_curve(const Distribution& from, const Distribution& to);

}  // namespace terrazzo
