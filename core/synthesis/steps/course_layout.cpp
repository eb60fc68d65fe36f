#include "core/synthesis/steps/course_layout.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <tbb/parallel_for.h>

#include "core/synthesis/steps/exemplar_courses.h"

namespace terrazzo {

namespace {

// In units, course heights, or pixels of the coursing's level.
constexpr double most_incoherent = 4;
constexpr double shortest_run = 0.9;     // what is shorter is no brick
constexpr double again = 6;              // by how far a course must go back to show what it has just shown
constexpr double near = 3;               // what shows so near in a course close by
constexpr double dear = 1;               // costs so much more,
constexpr int close_periods = 1;         // so many periods away or less
constexpr double gap = 2;                // what a joint costs that is missing, or twice as wide
constexpr double own = 1;                // what a course shows already is cheaper by so much,
constexpr double continued = 1;          // and so is what continues the course beside it,
constexpr double even = 1;               // and dearer what shows more often than others,
constexpr double most_even = 3;          // by so many times at most
constexpr double beside = 0.85;          // which is looked at so far from the middle
constexpr int most_columns = 6144;       // of the exemplar that are tried for one course
constexpr int most_off = 2;              // that what stays may be out of place
constexpr double most_staying = 0.25;    // of a run, before it does
constexpr double most_out_of_phase = 2;  // LatticePhase::penalty(): by as much as the lattice is unsure
constexpr double most_risen = 0.5;       // rows, after which a result that wraps does not meet itself

/// A course of the result.
struct ResultCourse {
  double begin, end;  ///< across, in rows of the field
  int kind;
  std::vector<CourseRun> runs{};

  int first_row() const { return int(std::ceil(begin - 0.5)); }
  int end_row() const { return int(std::ceil(end - 0.5)); }
  double middle() const { return (begin + end) / 2; }
};

class Bricklayer {
 public:
  Bricklayer(Field& field, int block, const CorrectionLevel& level, const Appearance& appearance,
             const Coursing& coursing, const LatticePhase& phase, const Task& task)
      : field_(field),
        level_(level),
        source_{level.exemplar, block},
        appearance_(appearance),
        looks_(appearance.levels()[size_t(coursing.level)]),
        coursing_(coursing),
        phase_(phase),
        task_(task),
        scale_(1 << coursing.level),
        axes_(result_axes()),
        step_(std::max(1, block / scale_)),
        blocks_(std::max(1, scale_ / block)),
        length_((axes_.upright ? field.size.height : field.size.width) / blocks_),
        closed_along_(axes_.upright ? level.window.closed_y : level.window.closed_x),
        closed_across_(axes_.upright ? level.window.closed_x : level.window.closed_y),
        columns_(exemplar_courses(looks_, coursing, source_, step_)),
        all_(result_courses()) {
    double height = 0;
    for (const ExemplarCourse& c : coursing.courses) height += (c.end - c.begin) / double(coursing.courses.size());
    fit_.step = step_;
    fit_.shortest = std::max(1, int(shortest_run * height / step_));
    fit_.again = int(again * height);
    fit_.per_difference = cost_per_difference(columns_, coursing);
    fit_.most_incoherent = int32_t(most_incoherent * cost_unit);
    fit_.per_gap = int32_t(gap * cost_unit * height / step_ / (2 * coursing.half_joint + 1));
    fit_.closed = closed_along_;
    near_ = int(near * height / step_);
  }

  /// Courses that see each other are laid one after the other.
  bool lay() {
    if (closed_along_ && std::abs(axes_.rise * length_ * blocks_) > most_risen) return false;
    const int count = int(all_.size()), apart = 2 * reach() + 1;
    // Around a result that wraps the last ones see the first ones.
    const int together = closed_across_ ? count - count % apart : count;
    for (int turn = 0; turn < std::min(apart, together); turn++) {
      count_use();
      tbb::parallel_for(0, (together - turn + apart - 1) / apart, [&](int i) { lay_course(turn + i * apart); });
    }
    for (int at = together; at < count; at++) {
      count_use();
      lay_course(at);
    }
    return true;
  }

 private:
  /// How many courses away a course looks.
  int reach() const { return close_periods * int(coursing_.beds.size()); }
  int kind_of(int course) const { return coursing_.courses[size_t(course)].kind; }
  int64_t pixel(int along, int across) const {
    const auto [x, y] = axes_.at(along, across);
    return pixel_index(field_.size, x, y, level_.window.closed_x, level_.window.closed_y);
  }
  /// What the field shows there, if it does.
  const ExemplarPixel* shown(int along, int across) const {
    const int64_t i = pixel(along, across);
    return i < 0 ? nullptr : &field_.pixels[size_t(i)];
  }

  CourseAxes result_axes() const {
    CourseAxes out{coursing_.axes.upright, 0};
    if (coursing_.axes.rise == 0) return out;
    constexpr int far = 1 << 14;
    const auto [x, y] = coursing_.axes.at(far, 0);
    const Vector2 from = phase_.shown_at(0, 0), to = phase_.shown_at(x, y);
    out.rise = out.upright ? (to.x - from.x) / (to.y - from.y) : (to.y - from.y) / (to.x - from.x);
    return out;
  }

  /// Where courses of the exemplar come in the result, continued in both directions.
  std::vector<ResultCourse> result_courses() const {
    constexpr int far = 1 << 12;
    const auto across = [&](const Vector2& at) { return axes_.across(at.x, at.y) / source_.block; };
    const double at0 = across(phase_.shown_at(0, 0));
    const double at1 = across(axes_.upright ? phase_.shown_at(far, 0) : phase_.shown_at(0, far));
    const double rate = (at1 - at0) / far * scale_;
    const auto row = [&](double v) { return at0 + rate * v; };
    const double breadth = axes_.upright ? field_.size.width : field_.size.height;
    const double risen = closed_across_ ? 0 : axes_.rise * length_ * blocks_;
    const double first = std::min(0.0, -risen), last = breadth + std::max(0.0, -risen);
    std::vector<ResultCourse> out;
    for (int n = int(std::floor((first - at0) / (rate * coursing_.period))) - 2; row(n * coursing_.period) < last; n++)
      for (size_t k = 0; k < coursing_.beds.size(); k++) {
        const double start = n * coursing_.period;
        const double next =
            k + 1 < coursing_.beds.size() ? coursing_.beds[k + 1] : coursing_.period + coursing_.beds[0];
        const double begin = row(start + coursing_.beds[k]), end = row(start + next);
        constexpr double tiny = 1e-6;
        if (closed_across_ ? begin >= -tiny && begin < breadth - tiny : end > first && begin < last)
          out.push_back({begin, end, int(k)});
      }
    return out;
  }

  void lay_course(int at) {
    task_.check();
    ResultCourse& course = all_[size_t(at)];
    const std::vector<int> tried = tried_for(course);
    if (tried.empty()) return;
    std::vector<ColumnLook> looks;
    for (int x = 0; x < length_; x++) {
      StripMeans means(course.begin, course.end);
      for (int row = course.first_row(); row < course.end_row(); row++)
        for (int k = 0; k < blocks_; k++)
          if (const ExemplarPixel* p = shown(x * blocks_ + k, row))
            means.add(row + 0.5, looks_.vectors[size_t(p->y / scale_) * looks_.size.width + p->x / scale_]);
      looks.push_back(means.means());
    }
    std::vector<TriedCourse> courses;
    for (const int c : tried) courses.push_back(in_phase(c, course));
    std::vector<ColumnPrice> prices;
    price_what_is_near(at, tried, prices);
    price_what_goes_on(course, tried, prices);
    price_what_is_used(tried, prices);
    course.runs = fitting_runs(looks, courses, prices, fit_);
    for (CourseRun& r : course.runs) r.course = tried[size_t(r.course)];
    for (size_t i = 0; i < course.runs.size(); i++) show(course.runs[i], end_of(course, i), course);
  }

  /// The column before which a run ends.
  int end_of(const ResultCourse& course, size_t run) const {
    if (run + 1 < course.runs.size()) return course.runs[run + 1].begin;
    return closed_along_ ? course.runs[0].begin + length_ : length_;
  }

  /// Courses of the exemplar, of the same kind: those that the course shows most, if there are too many.
  std::vector<int> tried_for(const ResultCourse& course) const {
    std::vector<int> votes(columns_.size(), 0), out;
    for (int x = 0; x < length_; x++)
      if (const ExemplarPixel* p = shown(x * blocks_, int(std::floor(course.middle()))))
        for (size_t c = 0; c < votes.size(); c++)
          votes[c] += shows_course(int(c), coursing_.axes.across(p->x, p->y) / scale_);
    for (int c = 0; c < int(columns_.size()); c++)
      if (kind_of(c) == course.kind) out.push_back(c);
    std::ranges::stable_sort(out, [&](int a, int b) { return votes[size_t(a)] > votes[size_t(b)]; });
    size_t columns = 0, count = 0;
    for (; count < out.size(); count++) {
      columns += columns_[size_t(out[count])].looks.size();
      if (count > 0 && columns > most_columns) break;
    }
    out.resize(count);
    std::ranges::sort(out);
    return out;
  }
  bool shows_course(int c, double across) const {
    return across >= coursing_.courses[size_t(c)].begin && across < coursing_.courses[size_t(c)].end;
  }

  /// A course with where it is in phase: bricks of a lattice stay where the lattice has them, as far as it is sure.
  TriedCourse in_phase(int c, const ResultCourse& course) const {
    TriedCourse out{&columns_[size_t(c)]};
    if (appearance_.lattice().rank < 2) return out;
    const double across = (coursing_.courses[size_t(c)].begin + coursing_.courses[size_t(c)].end) / 2 * scale_;
    const auto [x, y] = axes_.at(0, int(std::floor(course.middle() * source_.block + 0.5)));
    out.least_shift = -3 * length_ * step_;
    for (int shift = out.least_shift; shift < int(out.columns->looks.size()); shift++) {
      const auto [u, v] = coursing_.axes.at(shift * scale_, int(std::floor(across + 0.5)));
      out.in_phase.push_back(phase_.penalty(u, v, x, y) <= most_out_of_phase);
    }
    return out;
  }

  /// What courses that lie close show near by is dear.
  void price_what_is_near(int at, const std::vector<int>& tried, std::vector<ColumnPrice>& prices) const {
    const int count = int(all_.size());
    for (int d = -reach(); d <= reach(); d++) {
      const int other = closed_across_ ? wrap(at + d, count) : at + d;
      if (other < 0 || other >= count || other == at) continue;
      const ResultCourse& beside = all_[size_t(other)];
      for (size_t i = 0; i < beside.runs.size(); i++) {
        const CourseRun& run = beside.runs[i];
        const auto found = std::ranges::find(tried, run.course);
        if (found == tried.end()) continue;
        const int course = int(found - tried.begin()), end = end_of(beside, i);
        const int columns = int(columns_[size_t(run.course)].looks.size());
        for (int x = run.begin; x < end; x++)
          for (int column = run.from + (x - run.begin) * step_, s = 0; s < step_ && column < columns; s++, column++)
            prices.push_back({course, column, x - near_, x + near_ + 1, int32_t(dear * cost_unit)});
      }
    }
  }

  /// What a course shows already, and what continues what lies over or under it, is cheap.
  void price_what_goes_on(const ResultCourse& course, const std::vector<int>& tried,
                          std::vector<ColumnPrice>& prices) const {
    for (int d = -1; d <= 1; d++) {
      const double away = d * (course.end - course.begin) * beside;
      for (int x = 0; x < length_; x++) {
        const ExemplarPixel* p = shown(x * blocks_, int(std::floor(course.middle() + away)));
        if (!p) continue;
        const double across = (coursing_.axes.across(p->x, p->y) - away * source_.block) / scale_;
        for (size_t c = 0; c < tried.size(); c++) {
          const ExemplarCourse& e = coursing_.courses[size_t(tried[c])];
          if (std::abs(across - (e.begin + e.end) / 2) < (e.end - e.begin) / 4)
            prices.push_back({int(c), coursing_.axes.along(p->x, p->y) / scale_, x, x + 1,
                              -int32_t((d == 0 ? own : continued) * cost_unit)});
        }
      }
    }
  }

  /// How often the result shows each column of the exemplar, of how often it would if all showed alike.
  void count_use() {
    use_.clear();
    for (const CourseColumns& c : columns_) use_.emplace_back(c.looks.size(), 0.0f);
    std::vector<double> shown_of(coursing_.beds.size(), 0.0), there(coursing_.beds.size(), 0.0);
    for (const ResultCourse& r : all_)
      for (int x = 0; x < length_; x++) {
        const ExemplarPixel* p = shown(x * blocks_, int(std::floor(r.middle())));
        if (!p) continue;
        const double across = coursing_.axes.across(p->x, p->y) / scale_;
        for (size_t c = 0; c < columns_.size(); c++)
          if (shows_course(int(c), across)) {
            use_[c][size_t(coursing_.axes.along(p->x, p->y) / scale_)]++;
            shown_of[size_t(kind_of(int(c)))]++;
          }
      }
    for (size_t c = 0; c < columns_.size(); c++) there[size_t(kind_of(int(c)))] += double(columns_[c].looks.size());
    for (size_t c = 0; c < use_.size(); c++) {
      const ExemplarCourse& course = coursing_.courses[c];
      const auto kind = size_t(course.kind);
      const float usual = float(shown_of[kind] / there[kind]);
      use_[c] = smoothed(use_[c], std::max(1, int((course.end - course.begin) / 4)), usual);
    }
  }
  /// Of so many columns to each side together, as they come and go together; in units of `usual`.
  static std::vector<float> smoothed(const std::vector<float>& values, int reach, float usual) {
    const int n = int(values.size());
    std::vector<float> out(values.size(), 0.0f);
    for (int u = 0; u < n && usual > 0; u++) {
      const int begin = std::max(0, u - reach), end = std::min(n, u + reach + 1);
      for (int k = begin; k < end; k++) out[size_t(u)] += values[size_t(k)] / (usual * float(end - begin));
    }
    return out;
  }

  void price_what_is_used(const std::vector<int>& tried, std::vector<ColumnPrice>& prices) const {
    for (size_t c = 0; c < tried.size(); c++)
      for (size_t u = 0; u < use_[size_t(tried[c])].size(); u++) {
        const double often = double(use_[size_t(tried[c])][u]) - 1;
        prices.push_back({int(c), int(u), 0, length_, int32_t(even * cost_unit * std::clamp(often, -1.0, most_even))});
      }
  }

  /// By how much exemplar positions differ from those of the result, in pixels of the finest level.
  struct Offset {
    int along = 0, across = 0;
    auto operator<=>(const Offset&) const = default;
  };

  template <class F>
  void for_each_block(const CourseRun& run, int end, const ResultCourse& course, const F& f) const {
    for (int row = course.first_row(); row < course.end_row(); row++)
      for (int a = run.begin * blocks_; a < end * blocks_; a++)
        if (const int64_t i = pixel(a, row); i >= 0)
          f(size_t(i), a * source_.block, (row + axes_.shift(a)) * source_.block);
  }

  /// Where what shows along a run already is about what is to show there, that stays as it is.
  Offset offset_of(const CourseRun& run, int end, const ResultCourse& course) const {
    const ExemplarCourse& of = coursing_.courses[size_t(run.course)];
    const int middle = (run.begin + end) / 2 * blocks_, along = run.from * scale_ - run.begin * blocks_ * source_.block;
    const double up = (of.begin + of.end) / 2 * scale_ + coursing_.axes.rise * (middle * source_.block + along) -
                      (course.middle() + axes_.rise * middle) * source_.block;
    const Offset centred{along, int(std::floor(up + 0.5))};
    std::map<Offset, int> votes;
    int blocks = 0;
    for_each_block(run, end, course, [&](size_t i, int a, int row) {
      const ExemplarPixel p = field_.pixels[i];
      const int u = axes_.along(p.x, p.y), v = axes_.along(p.y, p.x);
      const Offset o{u - a, v - row};
      if (std::abs(o.along - centred.along) < step_ * scale_ &&
          std::abs(o.across - centred.across) <= most_off * scale_)
        votes[o]++;
      blocks++;
    });
    Offset best = centred;
    int most = int(most_staying * blocks);
    for (const auto& [offset, n] : votes)
      if (n > most) {
        most = n;
        best = offset;
      }
    return best;
  }

  void show(const CourseRun& run, int end, const ResultCourse& course) {
    const Offset offset = offset_of(run, end, course);
    for_each_block(run, end, course, [&](size_t i, int a, int row) {
      int x = a + offset.along, y = row + offset.across;
      if (axes_.upright) std::swap(x, y);
      if (source_.holds(x, y)) field_.pixels[i] = {uint16_t(x), uint16_t(y)};
    });
  }

  Field& field_;
  const CorrectionLevel& level_;
  BlockSource source_;
  const Appearance& appearance_;
  const AppearanceLevel& looks_;
  const Coursing& coursing_;
  const LatticePhase& phase_;
  const Task& task_;
  int scale_;  // pixels of the finest level to one of the coursing's
  CourseAxes axes_;
  int step_;    // pixels of the coursing's level to a column of the result
  int blocks_;  // of the field, likewise
  int length_;  // of courses, in columns
  bool closed_along_, closed_across_;
  std::vector<CourseColumns> columns_;  // of each course of the exemplar
  std::vector<ResultCourse> all_;
  std::vector<std::vector<float>> use_;  // of each column of those
  CourseFit fit_;
  int near_ = 0;
};

}  // namespace

bool lay_courses(Field& field, int block, const CorrectionLevel& level, const Appearance& appearance,
                 const Coursing& coursing, const LatticePhase& phase, const Task& task) {
  return !coursing.empty() && Bricklayer(field, block, level, appearance, coursing, phase, task).lay();
}

}  // namespace terrazzo
