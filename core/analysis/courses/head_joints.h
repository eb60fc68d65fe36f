#pragma once

#include <vector>

#include "core/analysis/courses/course_sheet.h"
#include "core/analysis/courses/exemplar_course.h"
#include "core/numeric/eigen.h"

namespace terrazzo {

/// Separates head joints from bricks in courses of one kind, by a linear discriminant learnt from bed joints and what
/// lies between them (Fisher, The use of multiple measurements in taxonomic problems, 1936).
class HeadJoints {
 public:
  /// `courses`: of one kind, partial ones included. `half_breadth`: of joints, in pixels. The sheet must outlive it.
  HeadJoints(const CourseSheet& sheet, const std::vector<ExemplarCourse>& courses, int half_breadth);

  /// Distance between the means of joints and bricks, in standard deviations.
  double separability() const { return separability_; }
  /// Per column of the sheet, how much it looks like a joint across the whole course: 0 as bricks on average, 1 as
  /// joints.
  std::vector<double> likeness(const ExemplarCourse& course) const;

  /// Head joints may be narrower, shallower or darker than bed joints: learns from the columns that stand out in
  /// `likeness`, one list per course. Returns false, and changes nothing, if there are too few.
  bool learn_from(const std::vector<ExemplarCourse>& courses, std::vector<std::vector<double>> likeness);

 private:
  class Samples;
  void separate(const Samples& samples);

  const CourseSheet& sheet_;
  int half_breadth_;
  VectorXd weights_;  ///< of a pixel's traits; empty if not separable
  double offset_ = 0;
  double separability_ = 0;
};

/// The rows of a course without its bed joints: begin..end.
struct CourseInside {
  CourseInside(const ExemplarCourse& course, int half_breadth);
  int begin, end;
};

/// Centres of the certain joints of a course, ascending, in pixels along it.
std::vector<double> sure_joints(const ExemplarCourse& course);

}  // namespace terrazzo
