#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "core/synthesis/steps/course_columns.h"

namespace terrazzo {

using CutIndex = uint16_t;
inline constexpr CutIndex no_cut = most_cuts + 1;
static_assert(no_cut == std::numeric_limits<CutIndex>::max());

/// The labels of the dynamic programme: the columns of all courses, one course after the other, numbered throughout;
/// and the cuts of all courses, likewise.
class CourseLabels {
 public:
  struct Cut {
    int course, label;
    int32_t cost;
    int joint_offset;
  };

  /// Borrows the courses.
  explicit CourseLabels(const std::vector<CandidateCourse>& courses) : courses_(courses) {
    for (size_t c = 0; c < courses.size(); c++) {
      columns_begin_.push_back(count_);
      cuts_begin_.push_back(int(cuts.size()));
      for (const CourseColumns::Cut& cut : courses[c].columns->cuts)
        cuts.push_back({int(c), count_ + cut.column, cut.cost, cut.joint_offset});
      count_ += int(courses[c].columns->looks.size());
    }
    if (cuts.size() > most_cuts) throw std::length_error("more cuts than can be numbered");
    columns_begin_.push_back(count_);
    cuts_begin_.push_back(int(cuts.size()));
    cut_at.assign(size_t(count_), no_cut);
    for (size_t k = 0; k < cuts.size(); k++)
      if (cuts[k].label < end(cuts[k].course)) cut_at[size_t(cuts[k].label)] = CutIndex(k);
  }

  int count() const { return count_; }
  int courses() const { return int(courses_.size()); }
  const CandidateCourse& course(int c) const { return courses_[size_t(c)]; }
  int begin(int course) const { return columns_begin_[size_t(course)]; }
  int end(int course) const { return columns_begin_[size_t(course) + 1]; }
  int cuts_begin(int course) const { return cuts_begin_[size_t(course)]; }
  int cuts_end(int course) const { return cuts_begin_[size_t(course) + 1]; }
  int length(int course) const { return end(course) - begin(course); }
  bool closed(int course) const { return courses_[size_t(course)].columns->closed; }
  /// So many columns before a label of a course; -1 if the course does not reach so far.
  int before(int course, int label, int columns) const {
    if (label - columns >= begin(course)) return label - columns;
    return closed(course) ? end(course) - 1 - (begin(course) - 1 - label + columns) % length(course) : -1;
  }
  int course_of(int label) const {
    return int(std::ranges::upper_bound(columns_begin_, label) - columns_begin_.begin()) - 1;
  }
  /// The run that begins in the result's column x with a label.
  CourseRun run(int x, int label) const {
    const int c = course_of(label);
    return {x, c, label - begin(c)};
  }

  std::vector<Cut> cuts;
  std::vector<CutIndex> cut_at;  ///< of each label; no_cut if there is none

 private:
  const std::vector<CandidateCourse>& courses_;
  int count_ = 0;
  std::vector<int> columns_begin_, cuts_begin_;
};

}  // namespace terrazzo
