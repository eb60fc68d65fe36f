#include "core/analysis/courses/coursing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <tbb/parallel_for.h>

#include "core/analysis/courses/bed_joints.h"
#include "core/analysis/courses/head_joints.h"
#include "core/base/tuning.h"

namespace terrazzo {

namespace {

struct CoursingTuning {
  double smallest_period = 14;
  double separability_of_bricks = 1.1;
  double separability_of_boards = 0.7;
  double most_aligned = 0.3;
  double separability_by_themselves = 1.4;
  double most_aligned_by_themselves = 0.1;
  double least_joints = 0.8;
  double shortest_board = 5;
  double least_shown = 0.8;
  double least_astray = 0.6;
  double least_between = 0.15;
  double clear = 2;
  int least_of_kind = 2;
};
const Tunable<CoursingTuning> coursing_tuning(
    "coursing",
    {
        {&CoursingTuning::smallest_period, "smallest_period", "pixels",
         "higher: fine walls are left to seams; lower: courses whose joints are lost are laid",
         "not measured: finer joints are lost", 4},
        {&CoursingTuning::separability_of_bricks, "separability_of_bricks", "deviations",
         "of joints like bed joints, between them and bricks. Higher: fewer walls are laid; lower: plaster is cut into "
         "stripes",
         "coursing"},
        {&CoursingTuning::separability_of_boards, "separability_of_boards", "deviations",
         "the same of boards, which are cut so seldom that a wrong joint costs less. Higher: fewer floors are laid; "
         "lower: boards are cut at knots",
         "not measured: the demands were measured together, not one by one"},
        {&CoursingTuning::most_aligned, "most_aligned", "share of the joints",
         "that may go on in the course below. Higher: tiles are laid as bricks, and cut up; lower: walls with some "
         "joints in line are not laid",
         "not measured: the demands were measured together, not one by one"},
        {&CoursingTuning::separability_by_themselves, "separability_by_themselves", "deviations",
         "of joints that were learnt, which were chosen for how they stand out. Higher: fewer walls are laid; lower: "
         "stains are taken for joints",
         "not measured: the demands were measured together, not one by one"},
        {&CoursingTuning::most_aligned_by_themselves, "most_aligned_by_themselves", "share of the joints",
         "as most_aligned, of joints that were learnt",
         "not measured: the demands were measured together, not one by one"},
        {&CoursingTuning::least_joints, "least_joints", "joints to a course",
         "higher: floors of long boards are left as they are; lower: courses are laid that can hardly be cut",
         "not measured: the demands were measured together, not one by one"},
        {&CoursingTuning::shortest_board, "shortest_board", "course heights",
         "from which on bricks count as boards. Higher: less is laid; lower: bricks with faint joints are laid",
         "not measured: taken over from the code before constants were listed"},
        {&CoursingTuning::least_shown, "least_shown", "share of the exemplar",
         "that whole courses must take: no result shows those that its border cuts off. Higher: less is laid; lower: "
         "results lose what was cut off",
         "course_layout"},
        {&CoursingTuning::least_astray, "least_astray", "joints to each brick of a lattice",
         "that do not come again with it. Higher: lattices keep bricks whole by themselves; lower: bricks are laid "
         "that are whole already",
         "What each rule decides"},
        {&CoursingTuning::least_between, "least_between", "share of the variance",
         "that lies between bricks. Higher: bricks that differ are left to the lattice; lower: those are laid of which "
         "no one can tell two halves",
         "course_layout", 0, 1},
        {&CoursingTuning::clear, "clear", "deviations",
         "from which on joints are clear, and seams look for others less far. Higher: missed joints are found; lower: "
         "boards keep no stubs of joints",
         "not measured: only near and far reaches were compared"},
        {&CoursingTuning::least_of_kind, "least_of_kind", "courses",
         "of each kind. Higher: less is laid; lower: one course comes all over",
         "not measured: the demands were measured together, not one by one", 1},
    });

constexpr double largest_period = 96;  // pixels; more is looked at where pixels are larger, which bounds the time

/// How far joints across and what is between them lie apart at least, in deviations, and how many go on in the course
/// below at most.
struct Demands {
  double bricks, boards, most_aligned;
};
Demands of_joints_like_beds() {
  return {coursing_tuning->separability_of_bricks, coursing_tuning->separability_of_boards,
          coursing_tuning->most_aligned};
}
Demands of_joints_by_themselves() {
  const double separability = coursing_tuning->separability_by_themselves;
  return {separability, separability, coursing_tuning->most_aligned_by_themselves};
}

/// All courses of one kind of which the exemplar shows something, whole or not; of one that tiles each once.
std::vector<ExemplarCourse> courses_of_kind(const Coursing& m, int kind, const CourseSheet& sheet) {
  std::vector<ExemplarCourse> out;
  const size_t k = size_t(kind);
  for (double start = sheet.wraps ? 0 : -m.period; start < sheet.breadth; start += m.period) {
    const double begin = start + m.beds[k];
    const double end = k + 1 < m.beds.size() ? start + m.beds[k + 1] : start + m.period + m.beds[0];
    // A period need not be whole pixels of a coarse level.
    if (sheet.wraps ? start + m.period / 2 < sheet.breadth : end > 0 && begin < sheet.breadth)
      out.push_back({begin, end, kind, {}});
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
double aligned_share(const Coursing& m) {
  int aligned = 0, all = 0;
  for (const ExemplarCourse& upper : m.courses)
    for (const ExemplarCourse& lower : m.courses) {
      if (std::abs(m.apart(lower.begin, upper.end)) > 1) continue;
      const std::vector<double> below = sure_joints(lower);
      for (const double u : sure_joints(upper)) {
        aligned += std::ranges::any_of(below, [&](double v) { return std::abs(u - v) <= m.half_joint + 1; });
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
  if (joints_astray(m.courses, step, m.half_joint) >= coursing_tuning->least_astray) return false;
  return !m.is_clear() || share_between_bricks(sheet, m.courses, m.half_joint) < coursing_tuning->least_between;
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

/// Whether joints can be separated from bricks, and bricks do end.
bool are_separable(const std::vector<ExemplarCourse>& courses, double separability, const Demands& demands) {
  double joints = 0;
  for (const ExemplarCourse& c : courses) joints += double(sure_joints(c).size());
  if (joints < coursing_tuning->least_joints * double(courses.size())) return false;
  const bool boards = usual_brick(courses) >= coursing_tuning->shortest_board * (courses[0].end - courses[0].begin);
  return separability >= (boards ? demands.boards : demands.bricks);
}

/// Returns of each course the likeness that it has them by.
std::vector<std::vector<double>> find_head_joints(std::vector<ExemplarCourse>& courses, const HeadJoints& head_joints,
                                                  const Task& task) {
  std::vector<std::vector<double>> likeness(courses.size());
  tbb::parallel_for(size_t{0}, courses.size(), [&](size_t i) {
    task.check();
    likeness[i] = head_joints.likeness(courses[i]);
    courses[i].joint.clear();
    for (const double column : likeness[i]) courses[i].joint.push_back(float(std::clamp(column, 0.0, 1.0)));
  });
  return likeness;
}

/// The courses of a kind, and what was demanded of them.
struct SeparableCourses {
  std::vector<ExemplarCourse> courses;
  Demands met;
};

/// Nothing if joints cannot be separated from bricks, or bricks hardly end.
SeparableCourses whole_courses(const CourseSheet& sheet, Coursing& m, int kind, const Task& task) {
  std::vector<ExemplarCourse> courses = courses_of_kind(m, kind, sheet);
  HeadJoints head_joints(sheet, courses, m.half_joint);
  std::erase_if(courses, [&](const ExemplarCourse& c) {
    const CourseInside inside(c, m.half_joint);
    return !sheet.has(inside.begin) || !sheet.has(inside.end - 1) || inside.end <= inside.begin;
  });
  if (int(courses.size()) < coursing_tuning->least_of_kind) return {};
  const double separability = head_joints.separability();
  m.separability = kind == 0 ? separability : std::min(m.separability, separability);
  if (separability < of_joints_like_beds().boards) return {};
  std::vector<std::vector<double>> likeness = find_head_joints(courses, head_joints, task);
  if (are_separable(courses, separability, of_joints_like_beds())) return {courses, of_joints_like_beds()};
  if (!head_joints.learn_from(courses, std::move(likeness))) return {};
  m.separability = std::min(m.separability, head_joints.separability());
  find_head_joints(courses, head_joints, task);
  if (!are_separable(courses, head_joints.separability(), of_joints_by_themselves())) return {};
  return {courses, of_joints_by_themselves()};
}

}  // namespace

bool Coursing::is_clear() const {
  return separability >= coursing_tuning->clear;
}

Coursing find_coursing(const Appearance& appearance, const Task& task) {
  const Lattice& lattice = appearance.lattice();
  Coursing out;
  Vector2d along = lattice.along_bands(true);
  out.axes = {along.x() == 0, along.x() == 0 ? 0 : along.y() / along.x()};
  if (out.axes.upright) along = lattice.along_bands(false);
  if (out.axes.upright && along.y() != 0) out.axes.rise = along.x() / along.y();
  const Lattice bands = lattice.level_bands(!out.axes.upright);
  if (bands.rank == 0) return {};
  out.period = std::abs(out.axes.upright ? bands.first.x() : bands.first.y());
  while (out.period > largest_period && out.level + 1 < int(appearance.levels().size())) {
    out.period /= 2;
    out.level++;
  }
  if (out.period < coursing_tuning->smallest_period) return {};
  const CourseSheet sheet(appearance.levels()[size_t(out.level)], out.axes, appearance.wraps());
  if (sheet.wraps) out.around = {sheet.length, sheet.breadth};
  const BedJoints beds = find_bed_joints(sheet, out.period);
  out.beds = beds.places;
  out.half_joint = beds.half_breadth;
  double most_aligned = 1;
  for (int kind = 0; kind < int(out.beds.size()); kind++) {
    task.check();
    const SeparableCourses found = whole_courses(sheet, out, kind, task);
    if (found.courses.empty()) return {};
    out.courses.insert(out.courses.end(), found.courses.begin(), found.courses.end());
    most_aligned = std::min(most_aligned, found.met.most_aligned);
  }
  if (shown_share(out.courses, sheet.breadth) < coursing_tuning->least_shown) return {};
  // What goes on across courses would be cut up with each of them. Lattices keep tiles in line, and whole, by
  // themselves.
  if (aligned_share(out) > most_aligned) return {};
  const double step = std::abs(out.axes.upright ? along.y() : along.x()) / (1 << out.level);
  if (lattice.rank == 2 && lattice_keeps_whole(sheet, out, step)) return {};
  return out;
}

}  // namespace terrazzo
