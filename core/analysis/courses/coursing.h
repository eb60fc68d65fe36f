#pragma once

#include <vector>

#include "core/analysis/courses/course_axes.h"
#include "core/analysis/courses/exemplar_course.h"
#include "core/base/task.h"
#include "core/exemplar/appearance.h"

namespace terrazzo {

/// The courses of an exemplar, and where each may be cut without cutting a brick.
struct Coursing {
  int level = 0;                        ///< of the pyramid, 0 = finest; positions are its pixels
  CourseAxes axes;                      ///< direction of the courses
  double period = 0;                    ///< pixels across, after which kinds repeat
  int half_joint = 0;                   ///< pixels of a joint to each side of its centre
  std::vector<double> beds;             ///< where the first course of each kind begins, in 0..period, ascending
  std::vector<ExemplarCourse> courses;  ///< those that lie wholly in the exemplar
  double separability = 0;              ///< of joints and bricks, in standard deviations; the least of all kinds
  bool empty() const { return courses.empty(); }
  bool is_clear() const;
};

/// Finds bed joints by the period of the lattice's courses or columns, then head joints by what separates bed joints
/// from bricks (Fisher's linear discriminant, 1936). Empty if the lattice has no courses, or joints are not separable.
/// Throws Cancelled.
Coursing find_coursing(const Appearance& appearance, const Task& task);

}  // namespace terrazzo
