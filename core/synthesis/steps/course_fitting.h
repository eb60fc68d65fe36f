#pragma once

#include <vector>

#include "core/synthesis/steps/course_columns.h"

namespace terrazzo {

/// The sequence of runs of the exemplar's courses, ascending, whose costs are least: differences from `shown`, prices
/// and cuts (dynamic programming; Viterbi, Error bounds for convolutional codes, 1967). `courses` have at most 65534
/// cuts in all. Empty if a result that wraps cannot be cut at all. Thread-safe.
std::vector<CourseRun> fitting_runs(const std::vector<ColumnLook>& shown, const std::vector<TriedCourse>& courses,
                                    const CoursePriceList& prices, const CourseFit& fit);

}  // namespace terrazzo
