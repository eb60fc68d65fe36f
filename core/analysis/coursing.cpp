#include "core/analysis/coursing.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "core/analysis/bed_joints.h"
#include "core/analysis/head_joints.h"

namespace terrazzo {

namespace {

constexpr double smallest_period = 14;  // pixels; finer joints are lost
constexpr double largest_period = 96;   // more is looked at where pixels are larger
// How far joints and what is between them lie apart, in deviations. Courses of boards are cut so seldom that it may be
// less.
constexpr double least_told_of_bricks = 1.1, least_told_of_boards = 0.7;
constexpr double shortest_board = 5;                 // course heights
constexpr int least_of_kind = 2, least_courses = 3;  // or there is nothing to choose from
constexpr double least_shown = 0.8;     // of the exemplar: no result shows courses that its border cuts off
constexpr double least_joints = 0.5;    // in a course of each kind
constexpr double most_aligned = 0.3;    // of joints that go on in the course below
constexpr double least_astray = 0.6;    // joints to each brick of a lattice which do not come again with it
constexpr double least_between = 0.15;  // share_between_bricks()
constexpr int least_inside = 3;         // rows of a course that belong to no joint

/// All courses of one kind of which the exemplar shows something, whole or not.
std::vector<ExemplarCourse> courses_of_kind(const Coursing& m, int kind, int breadth) {
  std::vector<ExemplarCourse> out;
  const size_t k = size_t(kind);
  for (double start = -m.period; start < breadth; start += m.period) {
    const double begin = start + m.beds[k];
    const double end = k + 1 < m.beds.size() ? start + m.beds[k + 1] : start + m.period + m.beds[0];
    if (end > 0 && begin < breadth) out.push_back({begin, end, kind, {}});
  }
  return out;
}

/// What share of so many rows whole courses take.
double shown_share(const std::vector<ExemplarCourse>& courses, int breadth) {
  double rows = 0;
  for (const ExemplarCourse& c : courses) rows += c.end - c.begin;
  return rows / breadth;
}

/// How many of the joints go on in a course below.
double aligned_share(const std::vector<ExemplarCourse>& courses, int half_joint) {
  int aligned = 0, all = 0;
  for (const ExemplarCourse& upper : courses)
    for (const ExemplarCourse& lower : courses) {
      if (std::abs(lower.begin - upper.end) > 1) continue;
      const std::vector<double> below = sure_joints(lower);
      for (const double u : sure_joints(upper)) {
        aligned += std::ranges::any_of(below, [&](double v) { return std::abs(u - v) <= half_joint + 1; });
        all++;
      }
    }
  return all > 0 ? double(aligned) / all : 0;
}

/// How many joints there are for every `step` along the courses that do not come again a step farther on.
double joints_astray(const std::vector<ExemplarCourse>& courses, double step, int half_joint) {
  double length = 0;
  int joints = 0, followed = 0, again = 0;
  for (const ExemplarCourse& c : courses) {
    const std::vector<double> sure = sure_joints(c);
    length += double(c.joint.size());
    joints += int(sure.size());
    for (const double u : sure) {
      if (u + step >= double(c.joint.size()) - half_joint - 1) continue;
      again += std::ranges::any_of(sure, [&](double v) { return std::abs(u + step - v) <= half_joint + 1; });
      followed++;
    }
  }
  return followed > 0 ? (1 - double(again) / followed) * joints * step / length : 0;
}

/// What share of all that bricks vary by is what they differ by as wholes: the intraclass correlation.
double share_between_bricks(const CourseSheet& sheet, const std::vector<ExemplarCourse>& courses, int half_joint) {
  const auto channels = size_t(sheet.channels());
  std::vector<double> sums(channels, 0.0), squares(channels, 0.0), of_means(channels, 0.0);
  double pixels = 0;
  const auto add_brick = [&](const CourseInside& inside, int begin, int end) {
    const double count = double(end - begin) * (inside.end - inside.begin);
    if (begin >= end) return;
    pixels += count;
    for (size_t k = 0; k < channels; k++) {
      double sum = 0;
      for (int v = inside.begin; v < inside.end; v++)
        for (int u = begin; u < end; u++) {
          const double value = sheet.at(u, v)[k];
          sum += value;
          squares[k] += value * value;
        }
      sums[k] += sum;
      of_means[k] += sum * sum / count;
    }
  };
  const int margin = half_joint + 2;
  for (const ExemplarCourse& c : courses) {
    const std::vector<double> joints = sure_joints(c);
    for (size_t i = 1; i < joints.size(); i++)
      add_brick(CourseInside(c, half_joint), int(joints[i - 1]) + margin, int(joints[i]) + 1 - margin);
  }
  double between = 0, all = 0;
  for (size_t k = 0; k < channels && pixels > 0; k++) {
    between += of_means[k] - sums[k] * sums[k] / pixels;
    all += squares[k] - sums[k] * sums[k] / pixels;
  }
  return all > 0 ? between / all : 0;
}

/// Whether bricks are whole where the lattice puts them together: if its steps are theirs, and no one can tell two
/// halves of theirs that do not belong together. Nor are they better cut at joints of which no one is sure.
bool lattice_keeps_whole(const CourseSheet& sheet, const Coursing& m, double step) {
  if (joints_astray(m.courses, step, m.half_joint) >= least_astray) return false;
  return !m.is_clear() || share_between_bricks(sheet, m.courses, m.half_joint) < least_between;
}

/// From joint to joint, as most are: where the exemplar shows few bricks from end to end, the mean of all.
double usual_brick(const std::vector<ExemplarCourse>& courses) {
  std::vector<double> bricks;
  double joints = 0, length = 0;
  for (const ExemplarCourse& c : courses) {
    const std::vector<double> sure = sure_joints(c);
    for (size_t i = 1; i < sure.size(); i++) bricks.push_back(sure[i] - sure[i - 1]);
    joints += double(sure.size());
    length += double(c.joint.size());
  }
  if (bricks.size() < courses.size()) return length / joints;
  const auto middle = bricks.begin() + std::ptrdiff_t(bricks.size() / 2);
  std::ranges::nth_element(bricks, middle);
  return *middle;
}

/// Nothing if joints cannot be told from bricks, or bricks hardly end.
std::vector<ExemplarCourse> whole_courses(const CourseSheet& sheet, Coursing& m, int kind, const Task& task) {
  std::vector<ExemplarCourse> courses = courses_of_kind(m, kind, sheet.breadth);
  const HeadJoints head_joints(sheet, courses, m.half_joint);
  if (head_joints.told() < least_told_of_boards) return {};
  m.told = kind == 0 ? head_joints.told() : std::min(m.told, head_joints.told());
  std::erase_if(courses, [&](const ExemplarCourse& c) {
    const CourseInside inside(c, m.half_joint);
    return inside.begin < 0 || inside.end > sheet.breadth || inside.end - inside.begin < least_inside;
  });
  tbb::parallel_for(size_t{0}, courses.size(), [&](size_t i) {
    task.check();
    courses[i].joint = head_joints.likeness(courses[i]);
  });
  double joints = 0;
  for (const ExemplarCourse& c : courses) joints += double(sure_joints(c).size());
  if (int(courses.size()) < least_of_kind || joints < least_joints * double(courses.size())) return {};
  const double height = courses[0].end - courses[0].begin;
  const bool boards = usual_brick(courses) >= shortest_board * height;
  return boards || head_joints.told() >= least_told_of_bricks ? courses : std::vector<ExemplarCourse>{};
}

}  // namespace

Coursing find_coursing(const Appearance& appearance, const Task& task) {
  Coursing out;
  Vector2 along = appearance.lattice().along_bands(true);
  out.axes = {along.x == 0, along.x == 0 ? 0 : along.y / along.x};
  if (out.axes.upright) along = appearance.lattice().along_bands(false);
  if (out.axes.upright && along.y != 0) out.axes.rise = along.x / along.y;
  const Lattice bands = appearance.lattice().level_bands(!out.axes.upright);
  if (bands.rank == 0) return {};
  out.period = std::abs(out.axes.upright ? bands.first.x : bands.first.y);
  while (out.period > largest_period && out.level + 1 < int(appearance.levels().size())) {
    out.period /= 2;
    out.level++;
  }
  if (out.period < smallest_period) return {};
  const CourseSheet sheet(appearance.levels()[size_t(out.level)], out.axes);
  const BedJoints beds = find_bed_joints(sheet, out.period);
  out.beds = beds.places;
  out.half_joint = beds.half_breadth;
  for (int kind = 0; kind < int(out.beds.size()); kind++) {
    task.check();
    const std::vector<ExemplarCourse> courses = whole_courses(sheet, out, kind, task);
    if (courses.empty()) return {};
    out.courses.insert(out.courses.end(), courses.begin(), courses.end());
  }
  if (int(out.courses.size()) < least_courses || shown_share(out.courses, sheet.breadth) < least_shown) return {};
  // What goes on across courses would be cut up with each of them. Lattices keep tiles in line, and whole, by
  // themselves.
  if (aligned_share(out.courses, out.half_joint) > most_aligned) return {};
  const double step = std::abs(out.axes.upright ? along.y : along.x) / (1 << out.level);
  if (appearance.lattice().rank == 2 && lattice_keeps_whole(sheet, out, step)) return {};
  return out;
}

}  // namespace terrazzo
