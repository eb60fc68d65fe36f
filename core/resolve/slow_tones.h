#pragma once

#include <memory>
#include <vector>

#include "core/base/task.h"
#include "core/image/image.h"

namespace terrazzo {

/// What changes slowly in a map of an exemplar, such as stains, clouds and vignettes: the map averaged over cells and
/// blurred, and how much it varies nearby. Immutable; thread-safe.
class SlowTones {
 public:
  /// Whether the tones of maps of this semantic can be joined: of colours, normals and other measured values, but not
  /// of heights (core/resolve/joined_heights.h), opacity, masks and data.
  static bool exist_in(const ImageInfo& info);

  /// The tones of a map of an exemplar that has this size. `reach`: the distance from a seam within which they are
  /// joined, in exemplar pixels, at least 1; what changes within twice that is texture. Throws Cancelled.
  SlowTones(const ImagePtr& map, Size exemplar, double reach, bool wraps, const Task& task);

  /// How much of the variance of the blurred map is between places that are farther apart than twice `reach`,
  /// 0..1: about 0.4
  /// for bricks, 0.5 for sand, 0.65 for stained metal and 0.9 for a vignette.
  double slow_share() const { return slow_share_; }
  /// Whether tones are slow enough that a seam between two of them would show.
  bool are_slow() const;

  double reach() const { return reach_; }
  int channels() const { return channels_; }  ///< those that carry values; alpha does not
  /// Adds the tones around a place, in exemplar pixels, times `weight` to `sum`, one number per channel. The place must
  /// lie within the exemplar.
  void add(double x, double y, float weight, float* sum) const;
  /// How much they vary within about `reach`: the root of the variances of all channels.
  float spread(double x, double y) const;

 private:
  struct Place;
  Place place(double x, double y) const;

  Size size_;  ///< in cells
  double cells_per_pixel_x_ = 1, cells_per_pixel_y_ = 1;
  double reach_;
  bool wraps_;
  int channels_;
  std::vector<float> tones_;   ///< interleaved
  std::vector<float> spread_;  ///< of all channels together
  double slow_share_ = 0;
};

using SlowTonesPtr = std::shared_ptr<const SlowTones>;

}  // namespace terrazzo
