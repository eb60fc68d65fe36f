#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/synthesis/steps/course_columns.h"

/// The dynamic programme behind fitting_runs().
namespace terrazzo {

using CutIndex = uint16_t;
inline constexpr CutIndex no_cut = std::numeric_limits<CutIndex>::max();

/// The labels of the dynamic programme: the columns of all courses, one course after the other, numbered throughout;
/// and the cuts of all courses, likewise.
class CourseLabels {
 public:
  struct Cut {
    int course, label;
    int32_t cost;
    int off_middle;
  };

  /// Borrows the courses. Throws std::length_error if they have more cuts than a CutIndex can number.
  CourseLabels(const std::vector<TriedCourse>& courses, const CourseFit& fit);

  int count() const { return count_; }
  int courses() const { return int(courses_.size()); }
  const TriedCourse& course(int c) const { return courses_[size_t(c)]; }
  int begin(int course) const { return columns_begin_[size_t(course)]; }
  int end(int course) const { return columns_begin_[size_t(course) + 1]; }
  int cuts_begin(int course) const { return cuts_begin_[size_t(course)]; }
  int cuts_end(int course) const { return cuts_begin_[size_t(course) + 1]; }
  /// The run that begins in the result's column x with a label.
  CourseRun run(int x, int label) const;

  std::vector<Cut> cuts;
  /// Of each label: the cut at which a run begins that reaches the minimum length there; no_cut if there is none.
  std::vector<CutIndex> completed_from;

 private:
  const std::vector<TriedCourse>& courses_;
  int count_ = 0;
  std::vector<int> columns_begin_, cuts_begin_;
};

/// The cheapest path through the result, from its first column to its last, as ascending runs; empty if there is none.
/// Every run must reach the minimum length before it may end, except at the result's borders. `shown` begins with the
/// result's column `origin`, and columns count from there. `first`: the cut at which the path begins, and also ends;
/// no_cut: it begins and ends anywhere.
std::vector<CourseRun> cheapest_path(const CourseLabels& labels, const CourseFit& fit,
                                     const std::vector<ColumnLook>& shown, const CoursePriceList& prices, int origin,
                                     CutIndex first);

}  // namespace terrazzo
