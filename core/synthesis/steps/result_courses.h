#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/analysis/courses/coursing.h"
#include "core/synthesis/state/correction_level.h"
#include "core/synthesis/steps/exemplar_courses.h"

namespace terrazzo {

/// A course of the result.
struct ResultCourse {
  double begin, end;  ///< across, in rows of the field
  int kind;
  std::vector<CourseRun> runs{};  ///< once it is laid

  int first_row() const { return int(std::ceil(begin - 0.5)); }
  int end_row() const { return int(std::ceil(end - 0.5)); }
  double middle() const { return (begin + end) / 2; }
};

/// Where the exemplar's courses lie in a result, continued in both directions, and what the result shows along them.
/// Positions along courses are columns, of one block of the field or several; positions across are rows of the field.
/// Borrows everything.
class ResultCourses {
 public:
  ResultCourses(const Field& field, const CorrectionLevel& level, const Coursing& coursing, const LatticePhase& phase);

  std::vector<ResultCourse> all;

  const CourseAxes& axes() const { return axes_; }
  int scale() const { return scale_; }        ///< pixels of the finest level to one of the coursing's
  int step() const { return step_; }          ///< pixels of the coursing's level to a column
  int blocks() const { return blocks_; }      ///< pixels of the field to a column
  int block() const { return level_.block; }  ///< pixels of the finest level to one of the field
  int length() const { return length_; }      ///< of courses, in columns
  bool closed_along() const { return closed_along_; }
  bool closed_across() const { return closed_across_; }
  /// By how many rows courses rise along the whole result.
  double risen() const { return axes_.rise * length_ * blocks_; }

  /// The field's pixel at a position along and across, both in pixels of the field; -1 if there is none.
  int64_t pixel(int along, int across) const;
  /// What it shows; null if there is none.
  const ExemplarPixel* shown(int along, int across) const {
    const int64_t i = pixel(along, across);
    return i < 0 ? nullptr : &field_.pixels[size_t(i)];
  }
  /// The column before which a run ends.
  int end_of(const ResultCourse& course, size_t run) const;
  /// Calls `f(pixel, along, across)` for each pixel of the field that a run covers, with positions in pixels of the
  /// finest level.
  template <class F>
  void for_each_block(const CourseRun& run, int end, const ResultCourse& course, const F& f) const {
    for (int row = course.first_row(); row < course.end_row(); row++)
      for (int a = run.begin * blocks_; a < end * blocks_; a++)
        if (const int64_t i = pixel(a, row); i >= 0)
          f(size_t(i), a * level_.block, (row + axes_.shift(a)) * level_.block);
  }

 private:
  std::vector<ResultCourse> found(const Coursing& coursing, const LatticePhase& phase) const;

  const Field& field_;
  const CorrectionLevel& level_;
  CourseAxes axes_;
  int scale_;
  int step_;
  int blocks_;
  int length_;
  bool closed_along_, closed_across_;
};

}  // namespace terrazzo
