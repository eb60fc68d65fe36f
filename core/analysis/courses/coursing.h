#pragma once

#include <vector>

#include "core/analysis/courses/course_axes.h"
#include "core/base/task.h"
#include "core/exemplar/appearance.h"

namespace terrazzo {

/// A course of bricks (tiles, blocks): what lies between the middles of two bed joints. Positions are pixels of the
/// level that was looked at, along the course and across.
struct ExemplarCourse {
  double begin = 0, end = 0;  ///< across the courses
  int kind = 0;               ///< courses of one kind come again after every period, as those of headers may
  std::vector<float> joint;   ///< of each pixel along the course, how much it looks like a joint across: 0..1
};

/// How an exemplar is built of courses, and where each may be cut without cutting a brick.
struct Coursing {
  int level = 0;                        ///< of the pyramid; the positions are its pixels
  CourseAxes axes;                      ///< how courses lie
  double period = 0;                    ///< after which kinds come again
  int half_joint = 0;                   ///< of a joint's breadth, without its middle
  std::vector<double> beds;             ///< where the first course of each kind may begin, in 0..period, ascending
  std::vector<ExemplarCourse> courses;  ///< those that lie in the exemplar as wholes
  double separability = 0;  ///< Fisher's, of joints and bricks: how far they lie apart, in deviations; of the kind of
                            ///< which it is least
  bool empty() const { return courses.empty(); }
  bool is_clear() const;
};

/// Bed joints are what differs from both its sides in the same way along all of the exemplar, once a period of the
/// lattice's level courses or columns. What separates their pixels from those between (Fisher's linear discriminant,
/// 1936) finds the joints across. Empty if the lattice has no courses, or their joints cannot be separated from bricks.
/// Throws Cancelled.
Coursing find_coursing(const Appearance& appearance, const Task& task);

}  // namespace terrazzo
