#pragma once

#include <vector>

#include "core/synthesis/steps/result_courses.h"

namespace terrazzo {

/// Which columns of the exemplar a course of the result should rather show, and which not: penalises columns shown
/// nearby in adjacent courses and columns that show more often than others, and favours what the course shows already
/// and what continues its neighbours. Borrows everything.
class CoursePrices {
 public:
  /// `columns`: of the exemplar's courses; `height`: their mean height, in pixels of the coursing's level.
  CoursePrices(const ResultCourses& result, const Coursing& coursing, const std::vector<CourseColumns>& columns,
               double height);

  /// How many courses away repeats are penalised.
  int reach() const;
  /// Counts how often the result shows each column of the exemplar.
  void count_use();
  /// The prices of course number `at`. `tried`: the exemplar's courses that it may show; prices name them by their
  /// place in that list.
  CourseCosts of(int at, const std::vector<int>& tried) const;

 private:
  std::vector<int32_t> cuts(int at) const;
  void add_repeats(int at, const std::vector<int>& tried, std::vector<ColumnPrice>& prices) const;
  void add_continued(const ResultCourse& course, const std::vector<int>& tried, std::vector<ColumnPrice>& prices) const;
  void add_use(const std::vector<int>& tried, std::vector<ColumnPrice>& prices) const;

  const ResultCourses& result_;
  const Coursing& coursing_;
  const std::vector<CourseColumns>& columns_;
  double height_;                        // in columns of the result
  int near_;                             // columns of the result
  std::vector<std::vector<float>> use_;  // of each column of each course, relative to an even use
};

}  // namespace terrazzo
