#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/task.h"
#include "core/image/image.h"

namespace terrazzo {

/// The lowest and the highest finite value; empty at first, with min above max.
struct ValueRange {
  float min = std::numeric_limits<float>::max();
  float max = std::numeric_limits<float>::lowest();
  /// Ignores values that are not finite, which computed pixels may have.
  void include(float v);
  /// The other range may be empty.
  void include(const ValueRange& other);
};

/// One per channel. Reads all pixels, in parallel, strip by strip; takes half of the task's progress. Throws Cancelled.
std::vector<ValueRange> value_ranges(const Image& image, const Task& task);

/// A histogram of one channel of an image. Values are binned into 65536 equal steps of the channel's range, so the
/// values of 8- and 16-bit maps stay distinct and exact. Immutable; thread-safe. The same for any number of threads.
class Distribution {
 public:
  struct Atom {
    float value = 0;
    uint64_t count = 0;
  };

  /// One per channel. Reads all pixels twice, in parallel, strip by strip. Throws Cancelled.
  static std::vector<Distribution> of(const Image& image, const Task& task);
  /// Merges several distributions into one.
  static Distribution merged(const std::vector<Distribution>& parts);

  /// Ascending in value; at least one.
  const std::vector<Atom>& atoms() const { return atoms_; }
  float min() const { return atoms_.front().value; }
  float max() const { return atoms_.back().value; }
  double mean() const;
  double deviation() const;

  /// For each atom the fraction of pixels below it, counting half of its own; ascending.
  const std::vector<double>& ranks() const { return ranks_; }
  /// The value at a rank in [0, 1], linear between atoms.
  double quantile(double rank) const;
  /// The threshold that maximises the between-class variance (Otsu, A threshold selection method from gray-level
  /// histograms, 1979): halfway between the atoms on either side.
  double otsu_threshold() const;

 private:
  explicit Distribution(std::vector<Atom> atoms);
  std::vector<Atom> atoms_;
  std::vector<double> ranks_;
};

/// A piecewise linear curve through points of ascending x, constant outside.
class PiecewiseLinear {
 public:
  PiecewiseLinear(std::vector<double> x, std::vector<double> y) : x_(std::move(x)), y_(std::move(y)) {}
  double operator()(double x) const;

 private:
  std::vector<double> x_, y_;
};

/// The curve that maps values distributed like `from` to the distribution `to`, each to the value of equal rank
/// (histogram specification by quantiles).
PiecewiseLinear matching_curve(const Distribution& from, const Distribution& to);

}  // namespace terrazzo
