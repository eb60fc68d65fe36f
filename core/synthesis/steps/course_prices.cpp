#include "core/synthesis/steps/course_prices.h"

#include <algorithm>
#include <cmath>

#include "core/base/tuning.h"

namespace terrazzo {

namespace {

struct CoursePricesTuning {
  double near = 3;
  double repeat_penalty = 1;
  double own = 1;
  double continued = 1;
  double neighbour_distance = 0.85;
  double middle_tolerance = 0.25;
  double even = 1;
  double use_reach = 0.25;
  double aligned = 3;
  double aligned_reach = 0.7;
  int close_periods = 1;
};
const Tunable<CoursePricesTuning> course_prices_tuning(
    "course_prices",
    {
        {&CoursePricesTuning::near, "near", "course heights",
         "how far along adjacent courses repeats count. Higher: bricks repeat farther apart; lower: bricks fit better",
         "What each rule decides", 0, 100},
        {&CoursePricesTuning::repeat_penalty, "repeat_penalty", "mean differences per column",
         "higher: the same brick seldom lies near itself; lower: bricks fit better", "What each rule decides", 0, 1000},
        {&CoursePricesTuning::own, "own", "mean differences per column",
         "higher: what a course shows already stays; lower: courses choose anew", "course_layout", 0, 1000},
        {&CoursePricesTuning::continued, "continued", "mean differences per column",
         "higher: courses continue their neighbours, in larger copies; lower: bricks mix more and break more",
         "course_layout", 0, 1000},
        {&CoursePricesTuning::neighbour_distance, "neighbour_distance", "course heights",
         "how far from the middle of a course its neighbours are read. Near 1: their middles; lower: their near sides",
         "What each rule decides"},
        {&CoursePricesTuning::middle_tolerance, "middle_tolerance", "course heights",
         "how far off the middle of an exemplar's course still counts as continued. Higher: more does; lower: only "
         "what is level",
         "What each rule decides"},
        {&CoursePricesTuning::even, "even", "mean differences per column",
         "higher: all bricks show equally often, and rare ones come back; lower: bricks fit better", "course_layout", 0,
         1000},
        {&CoursePricesTuning::use_reach, "use_reach", "course heights",
         "to each side, over which use is averaged. Higher: whole bricks count alike; lower: single columns do",
         "What each rule decides", 0, 100},
        {&CoursePricesTuning::aligned, "aligned", "mean differences times course heights",
         "what a cut right above or below another one costs. Higher: cuts are scattered; lower: bricks fit better",
         "course_layout", 0, 1000},
        {&CoursePricesTuning::aligned_reach, "aligned_reach", "course heights", "as far as that counts, less and less",
         "What each rule decides", 0, 100},
        {&CoursePricesTuning::close_periods, "close_periods", "periods of the coursing",
         "how many away courses count as adjacent. Higher: repeats are farther apart; costs time, as fewer courses are "
         "laid at once",
         "What each rule decides", 0, 100},
    });

int32_t cost(double differences) {
  return int32_t(differences * cost_unit);
}

/// The mean of each value and `reach` more to each side, in units of `usual`: neighbouring columns show together.
std::vector<float> smoothed(const std::vector<float>& values, int reach, float usual) {
  const int n = int(values.size());
  std::vector<float> out(values.size(), 0.0f);
  for (int u = 0; u < n && usual > 0; u++) {
    const int begin = std::max(0, u - reach), end = std::min(n, u + reach + 1);
    for (int k = begin; k < end; k++) out[size_t(u)] += values[size_t(k)] / (usual * float(end - begin));
  }
  return out;
}

}  // namespace

CoursePrices::CoursePrices(const ResultCourses& result, const Coursing& coursing,
                           const std::vector<CourseColumns>& columns, double height)
    : result_(result),
      coursing_(coursing),
      columns_(columns),
      height_(height / result.step()),
      near_(int(course_prices_tuning->near * height_)) {}

int CoursePrices::reach() const {
  return course_prices_tuning->close_periods * int(coursing_.beds.size());
}

void CoursePrices::count_use() {
  const int scale = result_.scale();
  use_.clear();
  for (const CourseColumns& c : columns_) use_.emplace_back(c.looks.size(), 0.0f);
  const auto kind_of = [&](size_t course) { return size_t(coursing_.courses[course].kind); };
  std::vector<double> shown(coursing_.beds.size(), 0.0), there(coursing_.beds.size(), 0.0);  // columns of each kind
  for (const ResultCourse& r : result_.all)
    for (int x = 0; x < result_.length(); x++) {
      const ExemplarPixel* p = result_.shown(x * result_.blocks(), int(std::floor(r.middle())));
      if (!p) continue;
      const double across = coursing_.axes.across(p->x, p->y) / scale;
      for (size_t c = 0; c < columns_.size(); c++)
        if (coursing_.covers(coursing_.courses[c], across)) {
          use_[c][size_t(coursing_.axes.along(p->x, p->y) / scale)]++;
          shown[kind_of(c)]++;
        }
    }
  for (size_t c = 0; c < columns_.size(); c++) there[kind_of(c)] += double(columns_[c].looks.size());
  for (size_t c = 0; c < use_.size(); c++) {
    const ExemplarCourse& course = coursing_.courses[c];
    const float usual = float(shown[kind_of(c)] / there[kind_of(c)]);
    use_[c] = smoothed(use_[c], std::max(1, int((course.end - course.begin) * course_prices_tuning->use_reach)), usual);
  }
}

CourseCosts CoursePrices::of(int at, const std::vector<int>& tried) const {
  CourseCosts prices;
  add_repeats(at, tried, prices.columns);
  add_continued(result_.all[size_t(at)], tried, prices.columns);
  add_use(tried, prices.columns);
  prices.cuts = cuts(at);
  return prices;
}

/// Keeps cuts from standing one above the other, as where a board ends at the exemplar's border in every course.
std::vector<int32_t> CoursePrices::cuts(int at) const {
  const int count = int(result_.all.size());
  const double reach = std::max(1.0, course_prices_tuning->aligned_reach * height_);
  std::vector<int32_t> prices(size_t(result_.length()), 0);
  for (const int d : {-1, 1}) {
    const int other = result_.closed_across() ? wrap(at + d, count) : at + d;
    if (other < 0 || other >= count || other == at) continue;
    for (const CourseRun& run : result_.all[size_t(other)].runs) {
      if (run.begin == 0) continue;
      for (int x = int(std::ceil(run.begin - reach)); x <= int(run.begin + reach); x++) {
        if (!result_.closed_along() && (x < 0 || x >= result_.length())) continue;
        const double near = 1 - std::abs(x - run.begin) / (reach + 1);
        prices[size_t(wrap(x, result_.length()))] += cost(course_prices_tuning->aligned * height_ * near);
      }
    }
  }
  return prices;
}

/// Penalises columns shown nearby in adjacent courses.
void CoursePrices::add_repeats(int at, const std::vector<int>& tried, std::vector<ColumnPrice>& prices) const {
  const int count = int(result_.all.size()), step = result_.step();
  const int32_t price = cost(course_prices_tuning->repeat_penalty);
  for (int d = -reach(); d <= reach(); d++) {
    const int other = result_.closed_across() ? wrap(at + d, count) : at + d;
    if (other < 0 || other >= count || other == at) continue;
    const ResultCourse& beside = result_.all[size_t(other)];
    for (size_t i = 0; i < beside.runs.size(); i++) {
      const CourseRun& run = beside.runs[i];
      const auto found = std::ranges::find(tried, run.course);
      if (found == tried.end()) continue;
      const int course = int(found - tried.begin()), end = result_.end_of(beside, i);
      const int columns = int(columns_[size_t(run.course)].looks.size());
      for (int x = run.begin; x < end; x++)
        for (int column = run.from + (x - run.begin) * step, s = 0; s < step; s++, column++)
          if (const int shown = columns_[size_t(run.course)].closed ? column % columns : column; shown < columns)
            prices.push_back({course, shown, x - near_, x + near_ + 1, price});
    }
  }
}

/// Favours what the course shows already and what continues the courses above and below.
void CoursePrices::add_continued(const ResultCourse& course, const std::vector<int>& tried,
                                 std::vector<ColumnPrice>& prices) const {
  const int scale = result_.scale();
  for (int d = -1; d <= 1; d++) {
    const double away = d * (course.end - course.begin) * course_prices_tuning->neighbour_distance;
    const int32_t price = -cost(d == 0 ? course_prices_tuning->own : course_prices_tuning->continued);
    for (int x = 0; x < result_.length(); x++) {
      const ExemplarPixel* p = result_.shown(x * result_.blocks(), int(std::floor(course.middle() + away)));
      if (!p) continue;
      const double across = (coursing_.axes.across(p->x, p->y) - away * result_.block()) / scale;
      for (size_t c = 0; c < tried.size(); c++) {
        const ExemplarCourse& e = coursing_.courses[size_t(tried[c])];
        if (std::abs(coursing_.apart(across, (e.begin + e.end) / 2)) <
            (e.end - e.begin) * course_prices_tuning->middle_tolerance)
          prices.push_back({int(c), coursing_.axes.along(p->x, p->y) / scale, x, x + 1, price});
      }
    }
  }
}

/// Penalises columns that show more often than others, and favours those that show less.
void CoursePrices::add_use(const std::vector<int>& tried, std::vector<ColumnPrice>& prices) const {
  for (size_t c = 0; c < tried.size(); c++)
    for (size_t u = 0; u < use_[size_t(tried[c])].size(); u++) {
      const int32_t price = cost(course_prices_tuning->even * (double(use_[size_t(tried[c])][u]) - 1));
      prices.push_back({int(c), int(u), 0, result_.length(), price});
    }
}

}  // namespace terrazzo
