#pragma once

#include <algorithm>

#include "core/analysis/courses/course_axes.h"
#include "core/analysis/space/appearance_space.h"
#include "core/base/geometry.h"

namespace terrazzo {

/// An exemplar level with its courses along the rows, and the channels of single pixels: appearance vectors depend on a
/// line's direction, and joints run both ways. Immutable; thread-safe.
class CourseSheet {
 public:
  static constexpr int most_channels = 12;

  /// The level must outlive the sheet. `tiles`: the exemplar does, and the sheet goes on around its borders.
  CourseSheet(const AppearanceLevel& level, const CourseAxes& axes, bool tiles)
      : wraps(tiles),
        length(axes.upright ? level.size.height : level.size.width),
        breadth(axes.upright ? level.size.width : level.size.height),
        level_(level),
        axes_(axes),
        pixels_(pixel_channels(level, most_channels)) {}

  const bool wraps;
  const int length, breadth;  ///< size along and across the courses, in pixels
  /// Whether there is such a row, or column, of courses.
  bool has(int across) const { return wraps || (across >= 0 && across < breadth); }
  int channels() const { return pixels_.channels; }
  const float* at(int along, int across) const { return &pixels_.values[index(along, across) * size_t(channels())]; }
  bool usable(int along, int across) const { return level_.usable.empty() || level_.usable[index(along, across)]; }

 private:
  /// Clamps, if the exemplar does not tile: rising courses leave the level in places.
  size_t index(int along, int across) const {
    const auto [x, y] = axes_.at(along, across);
    if (wraps) return size_t(wrap(y, level_.size.height)) * level_.size.width + wrap(x, level_.size.width);
    return size_t(std::clamp(y, 0, level_.size.height - 1)) * level_.size.width +
           std::clamp(x, 0, level_.size.width - 1);
  }

  const AppearanceLevel& level_;
  CourseAxes axes_;
  PixelChannels pixels_;
};

}  // namespace terrazzo
