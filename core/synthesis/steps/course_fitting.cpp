#include "core/synthesis/steps/course_fitting.h"

#include <algorithm>

#include "core/synthesis/steps/course_path.h"

namespace terrazzo {

namespace {

/// Runs of a result that wraps. In a path twice around, a cut in the middle does not depend on the ends. A second path
/// begins and ends there.
std::vector<CourseRun> runs_around(const CourseLabels& labels, const CourseFit& fit,
                                   const std::vector<ColumnLook>& shown, const CoursePriceList& prices) {
  const int length = int(shown.size());
  const auto path = [&](int from, int times, CutIndex first) {
    std::vector<ColumnLook> looks;
    for (int x = 0; x < times * length; x++) looks.push_back(shown[size_t((x + from) % length)]);
    CoursePriceList moved;
    for (int turn = -1; turn <= times; turn++)
      for (ColumnPrice p : prices.columns) {
        p.begin += turn * length - from;
        p.end += turn * length - from;
        moved.columns.push_back(p);
      }
    if (!prices.cuts.empty())
      for (int x = 0; x < times * length; x++) moved.cuts.push_back(prices.cuts[size_t((x + from) % length)]);
    return cheapest_path(labels, fit, looks, moved, from, first);
  };
  const std::vector<CourseRun> twice = path(0, 2, no_cut);
  const auto middle = std::ranges::find_if(twice, [&](const CourseRun& r) { return r.begin >= length / 2; });
  if (middle == twice.end() || middle->begin >= length / 2 + length) return {};
  const auto first = std::ranges::find_if(labels.cuts, [&](const CourseLabels::Cut& cut) {
    return cut.course == middle->course && cut.label == labels.begin(cut.course) + middle->from;
  });
  const int from = middle->begin % length;
  std::vector<CourseRun> runs = path(from, 1, CutIndex(first - labels.cuts.begin()));
  for (CourseRun& r : runs) r.begin = (r.begin + from) % length;
  std::ranges::sort(runs, {}, &CourseRun::begin);
  return runs;
}

}  // namespace

std::vector<CourseRun> fitting_runs(const std::vector<ColumnLook>& shown, const std::vector<TriedCourse>& courses,
                                    const CoursePriceList& prices, const CourseFit& fit) {
  const CourseLabels labels(courses, fit);
  return fit.closed ? runs_around(labels, fit, shown, prices) : cheapest_path(labels, fit, shown, prices, 0, no_cut);
}

}  // namespace terrazzo
