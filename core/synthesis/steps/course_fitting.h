#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/exemplar/appearance.h"

namespace terrazzo {

/// What a column of a course looks like: the mean of each strip along it.
inline constexpr int course_strips = 4;
using ColumnLook = std::array<AppearanceVector, course_strips>;

/// A course of the exemplar, column by column.
struct CourseColumns {
  std::vector<ColumnLook> looks;
  std::vector<uint8_t> usable;  ///< whether a result may show a column
  struct Cut {
    int column = 0;
    int32_t cost = 0;
    int off_middle = 0;  ///< by how many columns, of the joint that it goes through; at most farthest_off_middle
  };
  static constexpr int farthest_off_middle = 3;
  /// Before which columns a result may begin to show the course, or stop, if need be after the last: ascending, and
  /// what either costs.
  std::vector<Cut> cuts;
};

/// What a result shows from one of its columns on, up to the next run's.
struct CourseRun {
  int begin = 0;   ///< the first column of the result
  int course = 0;  ///< of the exemplar
  int from = 0;    ///< the exemplar's column that shows there
  bool operator==(const CourseRun&) const = default;
};

/// What it costs more, or less, to show a column of the exemplar in the result's columns from `begin` to before `end`.
struct ColumnPrice {
  int course = 0;
  int column = 0;
  int begin = 0, end = 0;
  int32_t price = 0;
};

/// A course of the exemplar that may be shown.
struct TriedCourse {
  const CourseColumns* columns = nullptr;
  /// Whether a run may begin that shows column `least_shift + i` in the result's first column, or its column `x` where
  /// that would be x steps further on. Empty: all may.
  std::vector<uint8_t> in_phase{};
  int least_shift = 0;
  bool fits(int shift) const { return in_phase.empty() || in_phase[size_t(shift - least_shift)]; }
};

struct CourseFit {
  int step = 1;      ///< columns of the exemplar to one of the result
  int shortest = 1;  ///< columns of the result that a run takes at least, but where the result begins or ends
  int again = 0;  ///< columns of the exemplar by which a run must go back if it goes on in the course of the one before
  double per_difference = 0;    ///< what a column costs by which the exemplar's differs from it,
  int32_t most_incoherent = 0;  ///< and at most
  int32_t per_gap = 0;          ///< each column costs by which a joint, put together from two, is too wide or narrow
  bool closed = false;          ///< the result wraps around: its last run goes on with its first columns
};

/// What two columns differ by.
int32_t difference(const ColumnLook& a, const ColumnLook& b);

/// The sequence of runs of the exemplar's courses that costs least, in what it differs from `shown` by, in prices and
/// in cuts (dynamic programming; Viterbi, Error bounds for convolutional codes, 1967), ascending. `courses` have 65534
/// cuts at most, all together. Empty if a result that wraps cannot be cut at all. Thread-safe.
std::vector<CourseRun> fitting_runs(const std::vector<ColumnLook>& shown, const std::vector<TriedCourse>& courses,
                                    const std::vector<ColumnPrice>& prices, const CourseFit& fit);

}  // namespace terrazzo
