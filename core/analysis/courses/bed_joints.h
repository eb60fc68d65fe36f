#pragma once

#include <vector>

#include "core/analysis/courses/course_sheet.h"

namespace terrazzo {

/// Bed joints, the joints between courses, as they repeat with every period across the courses.
struct BedJoints {
  int half_breadth = 0;        ///< of a joint: pixels to each side of its centre
  std::vector<double> places;  ///< centres, in 0..period, ascending; several if courses of different heights alternate
};

/// Finds lines that differ from both their sides in the same way along most of the sheet, once per `period` (pixels).
/// No places if there are none. Thread-safe.
BedJoints find_bed_joints(const CourseSheet& sheet, double period);

}  // namespace terrazzo
