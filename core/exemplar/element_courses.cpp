#include "core/exemplar/element_courses.h"

#include <algorithm>
#include <cmath>

#include "core/base/tuning.h"
#include "core/exemplar/joint_map.h"

namespace terrazzo {

namespace {

struct ElementCoursesTuning {
  double straight = 0.95;
  double most_aligned = 0.3;
};
const Tunable<ElementCoursesTuning> element_courses_tuning(
    "element_courses",
    {{&ElementCoursesTuning::straight, "straight", "share of a line's pixels",
      "that are near joints, from which on a joint goes all along it. Higher: rough courses are repeated as they are; "
      "lower: elements that reach over two courses are cut",
      "course_layout", 0.5, 1},
     {&ElementCoursesTuning::most_aligned, "most_aligned", "share of the joints",
      "across a course that may go on in the next. Higher: panels that belong together part; lower: walls with some "
      "joints in line are repeated as they are",
      "course_layout", 0, 1}});

/// The middles of the runs of lines all along which there is a joint; around the border.
std::vector<double> middles(const std::vector<uint8_t>& jointed) {
  const int n = int(jointed.size());
  const int first = int(std::ranges::find(jointed, 0) - jointed.begin());
  std::vector<double> out;
  for (int i = first; i < first + n; i++) {
    const int begin = i;
    while (i < first + n && jointed[size_t(wrap(i, n))]) i++;
    if (i > begin) out.push_back(std::fmod((begin + i) / 2.0, n));
  }
  std::ranges::sort(out);
  return out;
}

std::vector<double> beds_of(const JointMap& joints, bool rows) {
  std::vector<uint8_t> jointed;
  for (const double share : joints.near_shares(rows)) jointed.push_back(share >= element_courses_tuning->straight);
  return middles(jointed);
}

std::vector<double> joints_across(const JointMap& joints, Size size, bool upright, double begin, double end) {
  const int length = upright ? size.height : size.width, breadth = upright ? size.width : size.height;
  const int first = int(std::ceil(begin + joints.near())), last = int(std::floor(end - joints.near()));
  std::vector<uint8_t> out;
  for (int u = 0; u < length; u++) {
    int near = 0;
    for (int i = first; i <= last; i++) {
      const int v = wrap(i, breadth);
      near += upright ? joints.is_near(v, u) : joints.is_near(u, v);
    }
    out.push_back(last >= first && near >= element_courses_tuning->straight * (last - first + 1));
  }
  return middles(out);
}

/// The share of joints across that have one of the next course near them. `length`: of courses.
double aligned_share(const std::vector<std::vector<double>>& courses, int length, double near) {
  int aligned = 0, all = 0;
  for (size_t c = 0; c < courses.size(); c++)
    for (const double at : courses[c]) {
      aligned += std::ranges::any_of(courses[(c + 1) % courses.size()], [&](double other) {
        const double d = std::abs(at - other);
        return std::min(d, length - d) <= near;
      });
      all++;
    }
  return all > 0 ? double(aligned) / all : 1;
}

}  // namespace

Lattice ElementCourses::lattice(Size exemplar) const {
  if (empty()) return {};
  const Vector2d step = upright ? Vector2d{double(exemplar.width), 0} : Vector2d{0, double(exemplar.height)};
  return {1, step, {}, 1};
}

ElementCourses element_courses(const Elements& elements) {
  const JointMap joints(elements, true);
  const std::vector<double> rows = beds_of(joints, true), columns = beds_of(joints, false);
  if (rows.empty() == columns.empty()) return {};
  ElementCourses out{.upright = rows.empty(), .beds = rows.empty() ? columns : rows, .joints = {}};
  if (out.beds.size() < 2) return {};
  const int breadth = out.upright ? elements.size.width : elements.size.height;
  for (size_t k = 0; k < out.beds.size(); k++) {
    const double end = k + 1 < out.beds.size() ? out.beds[k + 1] : out.beds[0] + breadth;
    out.joints.push_back(joints_across(joints, elements.size, out.upright, out.beds[k], end));
  }
  if (std::ranges::any_of(out.joints, [](const auto& joints) { return joints.size() < 2; })) return {};
  if (aligned_share(out.joints, out.upright ? elements.size.height : elements.size.width, joints.near()) >
      element_courses_tuning->most_aligned)
    return {};
  return out;
}

}  // namespace terrazzo
