#include "core/synthesis/steps/result_courses.h"

#include <algorithm>

namespace terrazzo {

namespace {

/// The exemplar's axes as the lattice, which bends to wrap with the result, has them there.
CourseAxes result_axes(const Coursing& coursing, const LatticePhase& phase) {
  CourseAxes out{coursing.axes.upright, 0};
  if (coursing.axes.rise == 0) return out;
  constexpr int far = 1 << 14;
  const auto [x, y] = coursing.axes.at(far, 0);
  const Vector2d from = phase.shown_at(0, 0), to = phase.shown_at(x, y);
  const Vector2d run = to - from;
  out.rise = out.upright ? run.x() / run.y() : run.y() / run.x();
  return out;
}

}  // namespace

ResultCourses::ResultCourses(const Field& field, const CorrectionLevel& level, const Coursing& coursing,
                             const LatticePhase& phase)
    : field_(field),
      level_(level),
      axes_(result_axes(coursing, phase)),
      scale_(1 << coursing.level),
      step_(std::max(1, level.block / scale_)),
      blocks_(std::max(1, scale_ / level.block)),
      length_((axes_.upright ? field.size.height : field.size.width) / blocks_),
      closed_along_(axes_.upright ? level.window.closed_y : level.window.closed_x),
      closed_across_(axes_.upright ? level.window.closed_x : level.window.closed_y) {
  all = found(coursing, phase);
}

int64_t ResultCourses::pixel(int along, int across) const {
  const auto [x, y] = axes_.at(along, across);
  return level_.window.field().index(x, y);
}

int ResultCourses::end_of(const ResultCourse& course, size_t run) const {
  if (run + 1 < course.runs.size()) return course.runs[run + 1].begin;
  return closed_along_ ? course.runs[0].begin + length_ : length_;
}

std::vector<ResultCourse> ResultCourses::found(const Coursing& coursing, const LatticePhase& phase) const {
  constexpr int far = 1 << 12;
  const auto across = [&](const Vector2d& at) { return axes_.across(at.x(), at.y()) / level_.block; };
  const double at0 = across(phase.shown_at(0, 0));
  const double at1 = across(axes_.upright ? phase.shown_at(far, 0) : phase.shown_at(0, far));
  const double rate = (at1 - at0) / far * scale_;
  const auto row = [&](double v) { return at0 + rate * v; };
  const double breadth = axes_.upright ? field_.size.width : field_.size.height;
  const double rises = closed_across_ ? 0 : risen();
  const double first = std::min(0.0, -rises), last = breadth + std::max(0.0, -rises);
  constexpr double tiny = 1e-6;  // a course that begins at a border that wraps counts once, whatever the rounding
  const auto is_in_result = [&](double begin, double end) {
    return closed_across_ ? begin >= -tiny && begin < breadth - tiny : end > first && begin < last;
  };
  std::vector<ResultCourse> out;
  for (int n = int(std::floor((first - at0) / (rate * coursing.period))) - 2; row(n * coursing.period) < last; n++)
    for (size_t k = 0; k < coursing.beds.size(); k++) {
      const double start = n * coursing.period;
      const double next = k + 1 < coursing.beds.size() ? coursing.beds[k + 1] : coursing.period + coursing.beds[0];
      const double begin = row(start + coursing.beds[k]), end = row(start + next);
      if (is_in_result(begin, end)) out.push_back({begin, end, int(k)});
    }
  return out;
}

}  // namespace terrazzo
