#pragma once

#include <cmath>
#include <vector>

#include "core/analysis/courses/course_axes.h"
#include "core/analysis/courses/exemplar_course.h"
#include "core/base/geometry.h"
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
  /// Of an exemplar that tiles: pixels along and across courses after which it comes again. Else {0, 0}. Courses may
  /// go on around the border then.
  Size around{};
  double separability = 0;  ///< of joints and bricks, in standard deviations; the least of all kinds
  bool empty() const { return courses.empty(); }
  bool is_clear() const;
  /// How far a position across lies from another one; the shorter way around.
  double apart(double across, double other) const {
    const double d = across - other;
    return around.height == 0 ? d : d - around.height * std::floor(d / around.height + 0.5);
  }
  bool covers(const ExemplarCourse& course, double across) const {
    const double from_middle = apart(across, (course.begin + course.end) / 2), half = (course.end - course.begin) / 2;
    return from_middle >= -half && from_middle < half;
  }
};

/// Finds bed joints by the period of the lattice's courses or columns, then head joints by what separates bed joints
/// from bricks (Fisher's linear discriminant, 1936). Empty if the lattice has no courses, or joints are not separable.
/// Throws Cancelled.
Coursing find_coursing(const Appearance& appearance, const Task& task);

}  // namespace terrazzo
