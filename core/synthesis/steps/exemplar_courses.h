#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "core/analysis/courses/coursing.h"
#include "core/analysis/space/padded_level.h"
#include "core/synthesis/steps/course_fitting.h"

namespace terrazzo {

/// The cost of the mean difference between two columns of one kind of course: the unit of all costs.
inline constexpr int cost_unit = 256;

/// Accumulates a column's pixels into the means of its strips.
class StripMeans {
 public:
  StripMeans(double begin, double end) : begin_(begin), end_(end) {}
  /// `across`: the position of a pixel's middle, between the course's begin and end.
  void add(double across, const AppearanceVector& v) {
    const auto strip =
        size_t(std::clamp(int((across - begin_) / (end_ - begin_) * course_strips), 0, course_strips - 1));
    count_[strip]++;
    for (size_t d = 0; d < v.size(); d++) sum_[strip][d] += v[d];
  }
  ColumnDescriptor means() const {
    ColumnDescriptor out{};
    for (size_t s = 0; s < out.size(); s++)
      for (size_t d = 0; d < out[s].size(); d++) out[s][d] = int16_t(sum_[s][d] / std::max(1, count_[s]));
    return out;
  }

 private:
  double begin_, end_;
  std::array<int, course_strips> count_{};
  std::array<std::array<int, appearance_dimensions>, course_strips> sum_{};
};

/// The columns of all the exemplar's courses, and where they can be cut. A column through an element that reaches over
/// several courses is not usable. `step`: columns of the exemplar to one of the result. `exemplar`: the finest level.
std::vector<CourseColumns> exemplar_courses(const Appearance& appearance, const Coursing& coursing,
                                            const PaddedLevel& exemplar, int step);

/// The factor that scales differences so that those between two columns of one kind are cost_unit on average.
double cost_per_difference(const std::vector<CourseColumns>& columns, const Coursing& coursing);

}  // namespace terrazzo
