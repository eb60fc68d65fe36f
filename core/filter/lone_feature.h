#pragma once

#include <cstdint>
#include <vector>

#include "core/base/geometry.h"
#include "core/image/image.h"

namespace terrazzo {

/// Something that an exemplar shows only once, such as a sign, a lamp or a single stain. A larger result shows it again
/// and again, and the eye finds that first.
struct LoneFeature {
  double strength = 0;  ///< how unlike all the rest it is; 1: as two places of the exemplar are on average
  double usual = 0;     ///< the same of the exemplar's places by half: grain is unlike itself everywhere
  int x = 0, y = 0;     ///< its middle, in pixels

  // Measured in experiments.md, "lone_feature".
  bool is_seen() const { return strength > 1.35 && strength > 4 * usual; }
};

/// Gathers the colours of cells, about 40 along an exemplar's longer side. Used by one thread.
class LoneFeatureSearch {
 public:
  static constexpr int channels = 3;

  explicit LoneFeatureSearch(Size exemplar);
  /// Every so many rows and columns are enough of large exemplars; others are not counted.
  int step() const { return step_; }
  /// `colour`: of all channels, 0 to 1.
  void add(int x, int y, const double* colour);
  /// The place whose surroundings are least like any others, around the exemplar's borders too, but not where they cut
  /// it. Nothing in exemplars too small to tell.
  LoneFeature find() const;

 private:
  struct Cell {
    int64_t count = 0;
    double sum[channels] = {}, squares[channels] = {};
  };
  /// Of every cell its means and deviations, whole numbers: sums of them are the same on every machine.
  std::vector<int32_t> features() const;

  Size exemplar_;
  int step_;
  Size cells_{};  // 0x0: too small
  std::vector<Cell> sums_;
};

/// Of an image's first three channels.
LoneFeature lone_feature(const Image& image);

}  // namespace terrazzo
