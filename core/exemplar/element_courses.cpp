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
      "band_layout", 0.5, 1},
     {&ElementCoursesTuning::most_aligned, "most_aligned", "share of the joints",
      "across a course that may go on in the next. Higher: panels that belong together part; lower: walls with some "
      "joints in line are repeated as they are",
      "band_layout", 0, 1}});

/// The middles of the runs of lines all along which there is a joint; around the border of what `tiles`, and without
/// those that another border cuts.
std::vector<double> middles(std::vector<uint8_t> jointed, bool tiles) {
  const int n = int(jointed.size());
  if (!tiles) {
    std::fill(jointed.begin(), std::ranges::find(jointed, 0), 0);
    std::fill(std::find(jointed.rbegin(), jointed.rend(), 0).base(), jointed.end(), 0);
  }
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

std::vector<double> beds_of(const JointMap& joints, bool rows, bool tiles) {
  std::vector<uint8_t> jointed;
  for (const double share : joints.near_shares(rows)) jointed.push_back(share >= element_courses_tuning->straight);
  return middles(jointed, tiles);
}

std::vector<double> joints_across(const JointMap& joints, Size size, bool upright, bool tiles,
                                  const ExemplarSpan& band) {
  const int length = upright ? size.height : size.width, breadth = upright ? size.width : size.height;
  const int first = int(std::ceil(band.from + joints.near())), last = int(std::floor(band.to - joints.near()));
  std::vector<uint8_t> out;
  for (int u = 0; u < length; u++) {
    int near = 0;
    for (int i = first; i <= last; i++) {
      const int v = wrap(i, breadth);
      near += upright ? joints.is_near(v, u) : joints.is_near(u, v);
    }
    out.push_back(last >= first && near >= element_courses_tuning->straight * (last - first + 1));
  }
  return middles(out, tiles);
}

/// The share of joints across that have one of the next course near them. `around`: the length of courses that tile,
/// of which the first is next to the last; 0: they do not.
double aligned_share(const std::vector<std::vector<double>>& courses, int around, double near) {
  int aligned = 0, all = 0;
  for (size_t c = 0; c + (around > 0 ? 0 : 1) < courses.size(); c++)
    for (const double at : courses[c]) {
      aligned += std::ranges::any_of(courses[(c + 1) % courses.size()], [&](double other) {
        const double d = std::abs(at - other);
        return std::min(d, around > 0 ? around - d : d) <= near;
      });
      all++;
    }
  return all > 0 ? double(aligned) / all : 1;
}

/// From each place to the next. `around`: the length of an exemplar that tiles, whose last goes on around the border.
std::vector<ExemplarSpan> spans_between(const std::vector<double>& places, int around) {
  std::vector<ExemplarSpan> out;
  for (size_t i = 0; i + 1 < places.size(); i++) out.push_back({places[i], places[i + 1]});
  if (around > 0 && !places.empty()) out.push_back({places.back(), places[0] + around});
  return out;
}

/// Whether an element in a piece of a course goes on beyond it.
bool reaches_over(const Elements& elements, bool upright, bool tiles, const ExemplarSpan& band,
                  const ExemplarSpan& piece) {
  const auto element = [&](int along, double across) {
    const int x = upright ? int(across) : along, y = upright ? along : int(across);
    return elements
        .at[size_t(wrap(y, elements.size.height)) * size_t(elements.size.width) + size_t(wrap(x, elements.size.width))];
  };
  const double beside = band.length() / 4;
  for (int along = int(piece.from); along < int(piece.to); along++)
    for (const double bed : {band.from, band.to}) {
      const bool inside = bed - beside >= 0 && bed + beside < (upright ? elements.size.width : elements.size.height);
      if ((tiles || inside) && element(along, bed - beside) == element(along, bed + beside)) return true;
    }
  return false;
}

}  // namespace

Lattice ElementCourses::lattice(Size exemplar) const {
  if (empty()) return {};
  const Vector2d step = upright ? Vector2d{double(exemplar.width), 0} : Vector2d{0, double(exemplar.height)};
  return {1, step, {}, 1};
}

bool joints_cross(const Elements& elements) {
  const JointMap joints(elements, true);
  return !beds_of(joints, true, true).empty() && !beds_of(joints, false, true).empty();
}

ElementCourses element_courses(const Elements& elements, bool tiles) {
  const JointMap joints(elements, tiles);
  const std::vector<double> rows = beds_of(joints, true, tiles), columns = beds_of(joints, false, tiles);
  if (rows.empty() == columns.empty()) return {};
  const bool upright = rows.empty();
  const int length = upright ? elements.size.height : elements.size.width;
  const int breadth = upright ? elements.size.width : elements.size.height;
  ElementCourses out{
      .upright = upright, .bands = spans_between(upright ? columns : rows, tiles ? breadth : 0), .pieces = {}};
  if (out.bands.size() < 2) return {};
  std::vector<std::vector<double>> across;
  for (const ExemplarSpan& band : out.bands) {
    across.push_back(joints_across(joints, elements.size, upright, tiles, band));
    out.pieces.push_back(spans_between(across.back(), tiles ? length : 0));
    std::erase_if(out.pieces.back(),
                  [&](const ExemplarSpan& p) { return reaches_over(elements, upright, tiles, band, p); });
    if (out.pieces.back().size() < 2) return {};
  }
  if (aligned_share(across, tiles ? length : 0, joints.near()) > element_courses_tuning->most_aligned) return {};
  return out;
}

}  // namespace terrazzo
