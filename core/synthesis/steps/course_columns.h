#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/analysis/space/padded_level.h"

/// Courses column by column, and what showing them costs.
namespace terrazzo {

/// The appearance of a column of a course: the mean of each of its strips, from one bed joint to the next.
inline constexpr int course_strips = 4;
using ColumnDescriptor = std::array<AppearanceVector, course_strips>;

/// The squared distance of two columns, in eighths of squared appearance units per strip.
inline int32_t difference(const ColumnDescriptor& a, const ColumnDescriptor& b) {
  int32_t sum = 0;
  for (size_t s = 0; s < a.size(); s++) sum += squared_distance(a[s], b[s]) >> 3;
  return sum;
}

/// A course of the exemplar, column by column.
struct CourseColumns {
  std::vector<ColumnDescriptor> looks;
  std::vector<uint8_t> usable;  ///< whether a result may show a column
  struct Cut {
    int column = 0;
    int32_t cost = 0;
    int joint_offset = 0;  ///< columns from the middle of the joint that it cuts; at most farthest_joint_offset
  };
  static constexpr int farthest_joint_offset = 3;
  /// The columns before which a run may begin or end, and what either costs; ascending, perhaps one past the last.
  std::vector<Cut> cuts;
  bool closed = false;  ///< the exemplar tiles: the first column goes on from the last. No cut is past the last then
};

/// Consecutive columns of the exemplar that a result shows from one of its columns on, up to the next run.
struct CourseRun {
  int begin = 0;   ///< the first column of the result
  int course = 0;  ///< of the exemplar
  int from = 0;    ///< the exemplar's column that it shows there
  bool operator==(const CourseRun&) const = default;
};

/// An addition to the cost of showing a column of the exemplar in the result's columns from `begin` to before `end`.
struct ColumnPrice {
  int course = 0;
  int column = 0;
  int begin = 0, end = 0;
  int32_t price = 0;
};

inline constexpr size_t most_cuts = 65534;  ///< of all courses that are tried for one of the result

/// A course of the exemplar that a result may show.
struct CandidateCourse {
  const CourseColumns* columns = nullptr;
  /// Element i: whether runs may begin whose shift is `least_shift + i`. A run's shift is the exemplar's column that it
  /// shows, or would show if it were extended, in the result's first column. Empty: all may.
  std::vector<uint8_t> in_phase{};
  int least_shift = 0;
  bool fits(int shift) const { return in_phase.empty() || in_phase[size_t(shift - least_shift)]; }
};

struct CourseFit {
  int step = 1;  ///< columns of the exemplar to one of the result
  /// A run that goes back in the course of the one before goes back by at least so many columns of the exemplar, or by
  /// half of a course that is closed.
  int least_step_back = 0;
  double per_difference = 0;    ///< the cost per difference() of a column from what is shown,
  int32_t most_difference = 0;  ///< and its limit
  int32_t per_gap = 0;          ///< the cost per column by which a joint joined from two parts is too wide or narrow
  bool closed = false;          ///< the result wraps: its last run continues with its first columns
};

/// What a result's course costs beyond its look.
struct CourseCosts {
  std::vector<ColumnPrice> columns{};
  /// Of a run that begins in each of the result's columns; empty: nothing.
  std::vector<int32_t> cuts{};
};

}  // namespace terrazzo
