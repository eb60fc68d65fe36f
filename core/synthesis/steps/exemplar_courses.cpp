#include "core/synthesis/steps/exemplar_courses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <tbb/parallel_for.h>

#include "core/base/tuning.h"

namespace terrazzo {

namespace {

struct ExemplarCoursesTuning {
  double cut_joint = 0.5;
  double cut_brick = 6;
  double surely_brick = 0.5;
  double surely_joint = 0.9;
  double brick_cut_spacing = 0.25;
};
const Tunable<ExemplarCoursesTuning> exemplar_courses_tuning(
    "exemplar_courses",
    {
        {&ExemplarCoursesTuning::cut_joint, "cut_joint", "mean differences times course heights",
         "the cost of cutting a course in a joint. Higher: longer runs of the exemplar; lower: bricks mix more freely",
         "course_layout", 0, 1000},
        {&ExemplarCoursesTuning::cut_brick, "cut_brick", "mean differences times course heights",
         "the same in a brick. Higher: bricks stay whole; lower: figures improve, but bricks in two colours come back",
         "course_layout", 0, 1000},
        {&ExemplarCoursesTuning::surely_brick, "surely_brick", "likelihood of a joint, 0..1",
         "higher: faint joints are cut like bricks; lower: cuts go through bricks that look like joints",
         "What each rule decides", 0, 0.7},
        {&ExemplarCoursesTuning::surely_joint, "surely_joint", "likelihood of a joint, 0..1",
         "higher: only clear joints are cut at the price of a joint; lower: doubtful ones are too",
         "What each rule decides", 0.75, 1},
        {&ExemplarCoursesTuning::brick_cut_spacing, "brick_cut_spacing", "course heights",
         "higher: fewer columns of bricks can be cut, which saves time; lower: cuts find a better column",
         "What each rule decides", 0, 1000},
    });

// Of all pairs of columns, cost_per_difference() compares every seventh with another one, far from it.
constexpr size_t pair_stride = 7, pair_factor = 13, pair_offset = 5;

/// A course may reach into the exemplar's border, which is not shown: there the result stays as it is.
bool shows(const PaddedLevel& exemplar, const Coursing& coursing, int along, int across) {
  const int scale = 1 << coursing.level;
  auto [x, y] = coursing.axes.at(along * scale + scale / 2, across * scale + scale / 2);
  exemplar.unwind(x, y);
  int inside_x = x, inside_y = y;
  exemplar.settle_inside(inside_x, inside_y);
  (coursing.axes.upright ? x : y) = coursing.axes.upright ? inside_x : inside_y;
  return exemplar.holds(x, y);
}

/// Joints can be cut in or near their middle, bricks at some columns, at a higher cost.
/// `closed`: the course goes on around the exemplar's border.
std::vector<CourseColumns::Cut> cuts_of(const ExemplarCourse& course, double height, bool closed) {
  constexpr int far = CourseColumns::farthest_joint_offset;
  const ExemplarCoursesTuning t = *exemplar_courses_tuning;
  const int length = int(course.joint.size());
  const int spacing = std::max(1, int((course.end - course.begin) * t.brick_cut_spacing));
  std::map<int, CourseColumns::Cut> out;
  const auto add = [&](int at, double brick, int joint_offset) {
    const int u = closed ? wrap(at, length) : at;
    out[u] = {u, int32_t((t.cut_joint + (t.cut_brick - t.cut_joint) * brick) * cost_unit * height), joint_offset};
  };
  for (int u = 0; u < length; u += spacing) add(u, 1, 0);
  const auto joint = [&](int u) { return course.joint[size_t(wrap(u, length))]; };
  // Of a closed course none begins before where it is a brick.
  int first = 0;
  while (closed && first < length && joint(first) >= t.surely_brick) first++;
  for (int begin = first, end = first; begin < first + length; begin = end + 1) {
    double sum = 0, moment = 0;
    float most = 0;
    for (end = begin; end < first + length && joint(end) >= t.surely_brick; end++) {
      most = std::max(most, joint(end));
      sum += joint(end);
      moment += joint(end) * (end + 0.5);
    }
    if (begin == end) continue;
    // Joints cut by the exemplar's border have unknown centres.
    const int middle = closed          ? int(moment / sum + 0.5)
                       : begin == 0    ? 0
                       : end == length ? length
                                       : int(moment / sum + 0.5);
    const double brick = std::max(0.0, (t.surely_joint - most) / (t.surely_joint - t.surely_brick));
    for (int u = std::max(begin, middle - far); u <= std::min(end, middle + far); u++) add(u, brick, u - middle);
  }
  std::vector<CourseColumns::Cut> cuts;
  for (const auto& [u, cut] : out) cuts.push_back(cut);
  return cuts;
}

/// Whether the element at the upper or lower end of a column is the same beyond the bed joint there.
bool reaches_over(const Elements& elements, const Coursing& coursing, const ExemplarCourse& course, int along) {
  const int scale = 1 << coursing.level;
  const auto element = [&](double across) {
    auto [x, y] = coursing.axes.at(along * scale + scale / 2, int(std::floor(across * scale)));
    if (coursing.around.width > 0) {
      x = wrap(x, elements.size.width);
      y = wrap(y, elements.size.height);
    }
    if (x < 0 || y < 0 || x >= elements.size.width || y >= elements.size.height) return -1;
    return int(elements.at[size_t(y) * size_t(elements.size.width) + size_t(x)]);
  };
  const double beside = (course.end - course.begin) / 4;
  return std::ranges::any_of(std::array{course.begin, course.end}, [&](double bed) {
    const int above = element(bed - beside);
    return above >= 0 && above == element(bed + beside);
  });
}

CourseColumns columns_of(const Appearance& appearance, const Coursing& coursing, const PaddedLevel& exemplar, int step,
                         const ExemplarCourse& course) {
  const AppearanceLevel& looks = appearance.levels()[size_t(coursing.level)];
  CourseColumns out;
  out.closed = coursing.around.width > 0;
  const int begin = int(std::floor(course.begin + 0.5)), end = int(std::floor(course.end + 0.5));
  for (int u = 0; u < int(course.joint.size()); u++) {
    StripMeans means(course.begin, course.end);
    bool usable = !appearance.elements() || !reaches_over(*appearance.elements(), coursing, course, u);
    for (int v = begin; v < end; v++) {
      auto [x, y] = coursing.axes.at(u, v);
      if (out.closed) {
        x = wrap(x, looks.size.width);
        y = wrap(y, looks.size.height);
      }
      if (x >= 0 && y >= 0 && x < looks.size.width && y < looks.size.height)
        means.add(v + 0.5, looks.vectors[size_t(y) * looks.size.width + x]);
      usable &= shows(exemplar, coursing, u, v);
    }
    out.looks.push_back(means.means());
    out.usable.push_back(usable);
  }
  out.cuts = cuts_of(course, (course.end - course.begin) / step, out.closed);
  return out;
}

}  // namespace

std::vector<CourseColumns> exemplar_courses(const Appearance& appearance, const Coursing& coursing,
                                            const PaddedLevel& exemplar, int step) {
  std::vector<CourseColumns> out(coursing.courses.size());
  tbb::parallel_for(size_t{0}, out.size(),
                    [&](size_t c) { out[c] = columns_of(appearance, coursing, exemplar, step, coursing.courses[c]); });
  return out;
}

double cost_per_difference(const std::vector<CourseColumns>& columns, const Coursing& coursing) {
  double sum = 0, count = 0;
  for (size_t a = 0; a < columns.size(); a++)
    for (size_t b = a; b < columns.size(); b++) {
      if (coursing.courses[a].kind != coursing.courses[b].kind) continue;
      const std::vector<ColumnDescriptor>&p = columns[a].looks, &q = columns[b].looks;
      for (size_t i = 0; i < p.size(); i += pair_stride, count++)
        sum += difference(p[i], q[(i * pair_factor + pair_offset) % q.size()]);
    }
  return sum > 0 ? cost_unit * count / sum : 0;
}

}  // namespace terrazzo
