#pragma once

#include <vector>

#include "core/analysis/courses/course_sheet.h"

namespace terrazzo {

/// Where courses of bricks meet: what comes again with every period across them.
struct BedJoints {
  int half_breadth = 0;  ///< pixels to each side of the middle one
  std::vector<double>
      places;  ///< of middles, in 0..period, ascending; several where courses of several heights take turns
};

/// Bed joints differ from both their sides in the same way along most of the sheet. Empty if nothing does once a
/// period. Thread-safe.
BedJoints find_bed_joints(const CourseSheet& sheet, double period);

}  // namespace terrazzo
