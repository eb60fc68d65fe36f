#include "core/synthesis/steps/course_layout.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <tbb/parallel_for.h>

#include "core/base/tuning.h"
#include "core/synthesis/steps/course_fitting.h"
#include "core/synthesis/steps/course_prices.h"
#include "core/synthesis/steps/exemplar_courses.h"
#include "core/synthesis/steps/result_courses.h"

namespace terrazzo {

namespace {

struct CourseLayoutTuning {
  double most_difference = 4;
  double least_step_back = 6;
  double gap = 2;
  double most_staying = 0.25;
  double most_out_of_phase = 2;
  int most_columns = 6144;
};
const Tunable<CourseLayoutTuning> course_layout_tuning(
    "course_layout",
    {
        {&CourseLayoutTuning::most_difference, "most_difference", "mean differences",
         "the limit of what a column may cost by its look. Higher: single features count fully; lower: they do not "
         "outweigh the rest of a brick",
         "What each rule decides", 0, 1000},
        {&CourseLayoutTuning::least_step_back, "least_step_back", "course heights",
         "how far a course must go back in the exemplar to show it again. Higher: fewer repeats side by side; lower: "
         "short exemplars offer more",
         "What each rule decides", 0, 1000},
        {&CourseLayoutTuning::gap, "gap", "mean differences times course heights",
         "the cost of a joint that is missing, or twice as wide. Higher: joints keep their width; lower: cuts are "
         "freer",
         "course_layout", 0, 1000},
        {&CourseLayoutTuning::most_staying, "most_staying", "share of a run's blocks",
         "so many must agree on an offset for the run to keep it. Higher: runs are centred in their course more often; "
         "lower: more stays as it was",
         "What each rule decides", 0, 1},
        {&CourseLayoutTuning::most_out_of_phase, "most_out_of_phase", "phase penalty",
         "how far from the lattice runs may begin. Higher: more places fit; lower: bricks keep to the lattice",
         "What each rule decides"},
        {&CourseLayoutTuning::most_columns, "most_columns", "columns of the exemplar",
         "tried for one course. Higher: large exemplars are used fully; costs time and memory",
         "What each rule decides", 1, int(most_cuts) / 2 - 1},
    });

/// Lays the courses of a result.
class CourseLayout {
 public:
  CourseLayout(Field& field, const CorrectionLevel& level, const Appearance& appearance, const Coursing& coursing,
               const LatticePhase& phase, const Task& task)
      : field_(field),
        level_(level),
        appearance_(appearance),
        looks_(appearance.levels()[size_t(coursing.level)]),
        coursing_(coursing),
        phase_(phase),
        task_(task),
        result_(field, level, coursing, phase),
        columns_(exemplar_courses(appearance, coursing, level.exemplar, result_.step())),
        height_(mean_height(coursing)),
        prices_(result_, coursing, columns_, height_) {
    const int step = result_.step();
    fit_.step = step;
    fit_.least_step_back = int(course_layout_tuning->least_step_back * height_);
    fit_.per_difference = cost_per_difference(columns_, coursing);
    fit_.most_difference = int32_t(course_layout_tuning->most_difference * cost_unit);
    fit_.per_gap = int32_t(course_layout_tuning->gap * cost_unit * height_ / step / (2 * coursing.half_joint + 1));
    fit_.closed = result_.closed_along();
  }

  /// Courses within reach of each other's prices are laid one after the other, the others at the same time.
  bool lay() {
    if (result_.closed_along() && std::lround(result_.risen()) != 0) return false;
    const int count = int(result_.all.size()), apart = 2 * prices_.reach() + 1;
    // Around a result that wraps the last courses are within reach of the first ones.
    const int together = result_.closed_across() ? count - count % apart : count;
    for (int turn = 0; turn < std::min(apart, together); turn++) {
      prices_.count_use();
      tbb::parallel_for(0, (together - turn + apart - 1) / apart, [&](int i) { lay_course(turn + i * apart); });
    }
    for (int at = together; at < count; at++) {
      prices_.count_use();
      lay_course(at);
    }
    return true;
  }

 private:
  static double mean_height(const Coursing& coursing) {
    double height = 0;
    for (const ExemplarCourse& c : coursing.courses) height += (c.end - c.begin) / double(coursing.courses.size());
    return height;
  }

  void lay_course(int at) {
    task_.check();
    ResultCourse& course = result_.all[size_t(at)];
    course.runs = runs_as_shown(at);
    for (size_t i = 0; i < course.runs.size(); i++) show(course.runs[i], result_.end_of(course, i), course);
  }

  std::vector<CourseRun> runs_as_shown(int at) const {
    const ResultCourse& course = result_.all[size_t(at)];
    const std::vector<int> tried = tried_for(course);
    if (tried.empty()) return {};
    std::vector<CandidateCourse> courses;
    for (const int c : tried) courses.push_back(in_phase(c, course));
    CourseCosts prices = prices_.of(at, tried);
    // Where a lattice knows the bond, it says which joints stand above one another.
    if (appearance_.lattice().rank == 2) prices.cuts.clear();
    std::vector<CourseRun> runs = fitting_runs(looks_of(course), courses, prices, fit_);
    for (CourseRun& r : runs) r.course = tried[size_t(r.course)];
    return runs;
  }

  /// What each column of a course shows.
  std::vector<ColumnDescriptor> looks_of(const ResultCourse& course) const {
    const int blocks = result_.blocks(), scale = result_.scale();
    std::vector<ColumnDescriptor> looks;
    for (int x = 0; x < result_.length(); x++) {
      StripMeans means(course.begin, course.end);
      for (int row = course.first_row(); row < course.end_row(); row++)
        for (int k = 0; k < blocks; k++)
          if (const ExemplarPixel* p = result_.shown(x * blocks + k, row))
            means.add(row + 0.5, looks_.vectors[size_t(p->y / scale) * looks_.size.width + p->x / scale]);
      looks.push_back(means.means());
    }
    return looks;
  }

  /// The exemplar's courses of the same kind; if they are too many, those that the course shows most.
  std::vector<int> tried_for(const ResultCourse& course) const {
    std::vector<int> votes(columns_.size(), 0), out;
    for (int x = 0; x < result_.length(); x++)
      if (const ExemplarPixel* p = result_.shown(x * result_.blocks(), int(std::floor(course.middle()))))
        for (size_t c = 0; c < votes.size(); c++)
          votes[c] += coursing_.covers(coursing_.courses[c], coursing_.axes.across(p->x, p->y) / result_.scale());
    for (int c = 0; c < int(columns_.size()); c++)
      if (coursing_.courses[size_t(c)].kind == course.kind) out.push_back(c);
    std::ranges::stable_sort(out, [&](int a, int b) { return votes[size_t(a)] > votes[size_t(b)]; });
    size_t columns = 0, count = 0;
    for (; count < out.size(); count++) {
      columns += columns_[size_t(out[count])].looks.size();
      if (count > 0 && columns > size_t(course_layout_tuning->most_columns)) break;
    }
    out.resize(count);
    std::ranges::sort(out);
    return out;
  }

  /// A course of the exemplar with the shifts that are in phase: bricks of a lattice stay where the lattice has them,
  /// as far as it is certain.
  CandidateCourse in_phase(int c, const ResultCourse& course) const {
    CandidateCourse out{&columns_[size_t(c)]};
    if (appearance_.lattice().rank < 2) return out;
    const int scale = result_.scale();
    const double across = (coursing_.courses[size_t(c)].begin + coursing_.courses[size_t(c)].end) / 2 * scale;
    const auto [x, y] = result_.axes().at(0, int(std::floor(course.middle() * level_.block + 0.5)));
    out.least_shift = -3 * result_.length() * result_.step();  // fitting_runs() looks up to three times around
    for (int shift = out.least_shift; shift < int(out.columns->looks.size()); shift++) {
      const auto [u, v] = coursing_.axes.at(shift * scale, int(std::floor(across + 0.5)));
      out.in_phase.push_back(phase_.penalty(u, v, x, y) <= course_layout_tuning->most_out_of_phase);
    }
    return out;
  }

  /// The offset from positions of the result to those of the exemplar, in pixels of the finest level.
  struct Offset {
    int along = 0, across = 0;
    auto operator<=>(const Offset&) const = default;
  };

  /// The offset with which a run is shown: that of most blocks which already show about what the run is to show, so
  /// that those stay as they are; else the one that centres the exemplar's course.
  Offset offset_of(const CourseRun& run, int end, const ResultCourse& course) const {
    const int scale = result_.scale();
    const ExemplarCourse& of = coursing_.courses[size_t(run.course)];
    const int middle = (run.begin + end) / 2 * result_.blocks(),
              along = run.from * scale - run.begin * result_.blocks() * level_.block;
    const double up = (of.begin + of.end) / 2 * scale + coursing_.axes.rise * (middle * level_.block + along) -
                      (course.middle() + result_.axes().rise * middle) * level_.block;
    const Offset centred{along, int(std::floor(up + 0.5))};
    std::map<Offset, int> votes;
    int blocks = 0;
    result_.for_each_block(run, end, course, [&](size_t i, int a, int row) {
      const ExemplarPixel p = field_.pixels[i];
      const int u = result_.axes().along(p.x, p.y), v = result_.axes().along(p.y, p.x);
      Offset o{u - a, v - row};
      if (coursing_.around.width > 0) {
        const Size size = level_.exemplar.size();
        const auto [length, breadth] =
            result_.axes().upright ? std::pair(size.height, size.width) : std::pair(size.width, size.height);
        o = {centred.along + nearest_to_zero(o.along - centred.along, length),
             centred.across + nearest_to_zero(o.across - centred.across, breadth)};
      }
      if (std::abs(o.along - centred.along) < result_.step() * scale) votes[o]++;
      blocks++;
    });
    Offset best = centred;
    int most = int(course_layout_tuning->most_staying * blocks);
    for (const auto& [offset, n] : votes)
      if (n > most) {
        most = n;
        best = offset;
      }
    return best;
  }

  void show(const CourseRun& run, int end, const ResultCourse& course) {
    const Offset offset = offset_of(run, end, course);
    result_.for_each_block(run, end, course, [&](size_t i, int a, int row) {
      int x = a + offset.along, y = row + offset.across;
      if (result_.axes().upright) std::swap(x, y);
      level_.exemplar.unwind(x, y);
      // What tiles goes on beyond its border, also within a block.
      const bool shown = coursing_.around.width > 0 ? level_.exemplar.is_usable(x, y) : level_.holds(x, y);
      if (shown) field_.pixels[i] = {uint16_t(x), uint16_t(y)};
    });
  }

  Field& field_;
  const CorrectionLevel& level_;
  const Appearance& appearance_;
  const AppearanceLevel& looks_;
  const Coursing& coursing_;
  const LatticePhase& phase_;
  const Task& task_;
  ResultCourses result_;
  std::vector<CourseColumns> columns_;  // of each course of the exemplar
  double height_;                       // the mean of courses, in pixels of the coursing's level
  CoursePrices prices_;
  CourseFit fit_;
};

}  // namespace

bool lay_courses(Field& field, const CorrectionLevel& level, const Appearance& appearance, const Coursing& coursing,
                 const LatticePhase& phase, const Task& task) {
  return !coursing.empty() && CourseLayout(field, level, appearance, coursing, phase, task).lay();
}

}  // namespace terrazzo
