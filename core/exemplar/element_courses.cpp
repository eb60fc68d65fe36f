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

struct Joints {
  std::vector<double> places;  ///< their middles, ascending
  /// Of what follows on the last one: the first one around the border of what tiles, else that border, or a joint on
  /// it.
  double end = 0;
};

/// By the runs of lines all along which pixels are near a joint, around the border of what `tiles`.
Joints joints_of(std::vector<uint8_t> jointed, bool tiles, double near) {
  const int n = int(jointed.size());
  Joints out{{}, double(n)};
  if (!tiles) {
    const auto at_border = std::find(jointed.rbegin(), jointed.rend(), 0) - jointed.rbegin();
    if (at_border > 0) out.end = std::min(out.end, double(n - at_border) + near);
    std::fill(jointed.begin(), std::ranges::find(jointed, 0), 0);
    std::fill(std::find(jointed.rbegin(), jointed.rend(), 0).base(), jointed.end(), 0);
  }
  const int first = int(std::ranges::find(jointed, 0) - jointed.begin());
  for (int i = first; i < first + n; i++) {
    const int begin = i;
    while (i < first + n && jointed[size_t(wrap(i, n))]) i++;
    if (i > begin) out.places.push_back(std::fmod((begin + i) / 2.0, n));
  }
  std::ranges::sort(out.places);
  if (tiles && !out.places.empty()) out.end += out.places.front();
  return out;
}

Joints beds_of(const JointMap& joints, bool rows, bool tiles) {
  std::vector<uint8_t> jointed;
  for (const double share : joints.near_shares(rows)) jointed.push_back(share >= element_courses_tuning->straight);
  return joints_of(jointed, tiles, joints.near());
}

Joints joints_across(const JointMap& joints, Size size, bool upright, bool tiles, const ExemplarSpan& band) {
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
  return joints_of(out, tiles, joints.near());
}

/// The share of joints across that have one of the next course near them. `around`: the length of courses that tile,
/// of which the first is next to the last; 0: they do not.
double aligned_share(const std::vector<Joints>& courses, int around, double near) {
  int aligned = 0, all = 0;
  for (size_t c = 0; c + (around > 0 ? 0 : 1) < courses.size(); c++)
    for (const double at : courses[c].places) {
      aligned += std::ranges::any_of(courses[(c + 1) % courses.size()].places, [&](double other) {
        const double d = std::abs(at - other);
        return std::min(d, around > 0 ? around - d : d) <= near;
      });
      all++;
    }
  return all > 0 ? double(aligned) / all : 1;
}

/// From each joint to the next. Where that is less than half of all, what the far border cuts counts as well, if enough
/// is left of it: each span begins with a joint, so wherever two meet there is one, if of half its breadth.
std::vector<ExemplarSpan> spans_between(const Joints& joints, bool tiles) {
  std::vector<ExemplarSpan> out;
  if (joints.places.empty()) return out;
  double longest = joints.places.front(), whole = 0;
  for (size_t i = 0; i + 1 < joints.places.size(); i++) {
    out.push_back({joints.places[i], joints.places[i + 1]});
    longest = std::max(longest, out.back().length());
    whole += out.back().length();
  }
  const ExemplarSpan last{joints.places.back(), joints.end};
  if (tiles || (whole < joints.end / 2 && last.length() >= longest / 2)) out.push_back(last);
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

CoursePieces ElementCourses::pieces_for(const ExemplarSpan& band) const {
  CoursePieces out;
  const double unseen = std::max(1.0, Lattice{1, {}, {}, 1}.unseen_bend() * band.length());
  for (size_t i = 0; i < bands.size(); i++) {
    if (std::abs(bands[i].length() - band.length()) > unseen) continue;
    out.pieces.insert(out.pieces.end(), pieces[i].begin(), pieces[i].end());
    out.bands.resize(out.pieces.size(), bands[i]);
  }
  return out;
}

Lattice ElementCourses::lattice(Size exemplar) const {
  if (empty()) return {};
  const Vector2d step = upright ? Vector2d{double(exemplar.width), 0} : Vector2d{0, double(exemplar.height)};
  return {1, step, {}, 1};
}

bool joints_cross(const Elements& elements) {
  const JointMap joints(elements, true);
  return !beds_of(joints, true, true).places.empty() && !beds_of(joints, false, true).places.empty();
}

ElementCourses element_courses(const Elements& elements, bool tiles) {
  const JointMap joints(elements, tiles);
  const Joints rows = beds_of(joints, true, tiles), columns = beds_of(joints, false, tiles);
  if (rows.places.empty() == columns.places.empty()) return {};
  const bool upright = rows.places.empty();
  const int length = upright ? elements.size.height : elements.size.width;
  ElementCourses out{.upright = upright, .bands = spans_between(upright ? columns : rows, tiles), .pieces = {}};
  if (out.bands.size() < 2) return {};
  std::vector<Joints> across;
  for (const ExemplarSpan& band : out.bands) {
    across.push_back(joints_across(joints, elements.size, upright, tiles, band));
    out.pieces.push_back(spans_between(across.back(), tiles));
    std::erase_if(out.pieces.back(),
                  [&](const ExemplarSpan& p) { return reaches_over(elements, upright, tiles, band, p); });
  }
  const auto has_none = [&](const ExemplarSpan& band) { return out.pieces_for(band).pieces.empty(); };
  if (std::ranges::any_of(out.bands, has_none)) return {};
  if (aligned_share(across, tiles ? length : 0, joints.near()) > element_courses_tuning->most_aligned) return {};
  return out;
}

}  // namespace terrazzo
