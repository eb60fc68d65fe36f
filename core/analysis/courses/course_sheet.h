#pragma once

#include <algorithm>

#include "core/analysis/courses/course_axes.h"
#include "core/analysis/space/appearance_space.h"

namespace terrazzo {

/// An exemplar level turned so that its courses run along the rows, and what its pixels show themselves: appearance
/// vectors know which way a line runs, and joints run both ways.
class CourseSheet {
 public:
  static constexpr int most_channels = 12;

  /// The level must outlive the sheet.
  CourseSheet(const AppearanceLevel& level, const CourseAxes& axes)
      : length(axes.upright ? level.size.height : level.size.width),
        breadth(axes.upright ? level.size.width : level.size.height),
        level_(level),
        axes_(axes),
        pixels_(pixel_channels(level, most_channels)) {}

  const int length, breadth;  ///< along the courses and across them
  int channels() const { return pixels_.channels; }
  const float* at(int along, int across) const { return &pixels_.values[index(along, across) * size_t(channels())]; }
  bool usable(int along, int across) const { return level_.usable.empty() || level_.usable[index(along, across)]; }

 private:
  /// Courses that rise leave the level here and there.
  size_t index(int along, int across) const {
    const auto [x, y] = axes_.at(along, across);
    return size_t(std::clamp(y, 0, level_.size.height - 1)) * level_.size.width +
           std::clamp(x, 0, level_.size.width - 1);
  }

  const AppearanceLevel& level_;
  CourseAxes axes_;
  PixelChannels pixels_;
};

}  // namespace terrazzo
