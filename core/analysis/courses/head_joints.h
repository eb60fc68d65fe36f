#pragma once

#include <vector>

#include "core/analysis/courses/course_sheet.h"
#include "core/analysis/courses/coursing.h"
#include "core/numeric/eigen.h"

namespace terrazzo {

/// Separates joints across courses of one kind from bricks, by what separates what lies along the courses' bed joints
/// from what lies between them (Fisher's linear discriminant; The use of multiple measurements in taxonomic problems,
/// 1936).
class HeadJoints {
 public:
  /// `courses`: those of one kind, also ones of which the exemplar has only a part. `half_breadth`: of joints.
  HeadJoints(const CourseSheet& sheet, const std::vector<ExemplarCourse>& courses, int half_breadth);

  /// Fisher's: how far the means of joints and bricks lie apart, in standard deviations.
  double separability() const { return separability_; }
  /// Of every column of the sheet how much it looks like a joint all through the course: 0 as bricks do on average, 1
  /// as joints do.
  std::vector<double> likeness(const ExemplarCourse& course) const;

  /// Joints across may be narrower, shallower or darker than those along the courses: knows them from then on by those
  /// columns of these courses that stand out from the others in `likeness`, which is each course's. Returns false, and
  /// changes nothing, if there are hardly any.
  bool learn_from(const std::vector<ExemplarCourse>& courses, std::vector<std::vector<double>> likeness);

 private:
  class Samples;
  void separate(const Samples& samples);

  const CourseSheet& sheet_;
  int half_breadth_;
  VectorXd weights_;  ///< of a pixel's traits; empty: nothing separates them
  double offset_ = 0;
  double separability_ = 0;
};

/// The rows of a course that belong to no bed joint.
struct CourseInside {
  CourseInside(const ExemplarCourse& course, int half_breadth);
  int begin, end;
};

/// The middles of the joints that a course surely has, ascending.
std::vector<double> sure_joints(const ExemplarCourse& course);

}  // namespace terrazzo
