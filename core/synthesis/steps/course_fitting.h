#pragma once

#include <vector>

#include "core/synthesis/steps/course_columns.h"

namespace terrazzo {

/// The sequence of runs of the exemplar's courses, ascending, whose costs are least: differences from `shown`, prices
/// and cuts (dynamic programming; Viterbi, Error bounds for convolutional codes, 1967). Throws
/// std::length_error if `courses` have more than most_cuts. Empty if a result that wraps cannot be cut at all.
/// Thread-safe.
std::vector<CourseRun> fitting_runs(const std::vector<ColumnDescriptor>& shown,
                                    const std::vector<CandidateCourse>& courses, const CourseCosts& prices,
                                    const CourseFit& fit);

}  // namespace terrazzo
