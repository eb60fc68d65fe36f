#include "core/synthesis/steps/course_fitting.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

#include "core/synthesis/steps/course_labels.h"

namespace terrazzo {

namespace {

// Costs, of which a few may be added without overflow.
constexpr int32_t impossible = 1 << 30;
constexpr int32_t forbidden = 1 << 24;  // of a column that must not be shown

/// The cheapest of several cuts.
struct Cheapest {
  int32_t cost = impossible;
  CutIndex cut = no_cut;
  void consider(const Cheapest& other) {
    if (other.cost < cost) *this = other;
  }
};

/// The cheapest cuts at which runs end, for each part of a joint that the next run may begin with.
class CheapestEnds {
 public:
  explicit CheapestEnds(int32_t per_gap) : per_gap_(per_gap) {}
  void consider(int32_t cost, CutIndex k, int joint_offset) {
    if (cost >= impossible) return;
    for (int to = -farthest; to <= farthest; to++)
      by_part_[size_t(to + farthest)].consider({cost + per_gap_ * std::abs(joint_offset - to), k});
  }
  void consider(const CheapestEnds& other) {
    for (size_t part = 0; part < by_part_.size(); part++) by_part_[part].consider(other.by_part_[part]);
  }
  const Cheapest& to(int joint_offset) const { return by_part_[size_t(joint_offset + farthest)]; }

 private:
  static constexpr int farthest = CourseColumns::farthest_joint_offset;
  int32_t per_gap_;
  std::array<Cheapest, 2 * farthest + 1> by_part_;
};

/// Finds the cheapest path through the result, from its first column to its last.
class PathSearch {
 public:
  /// `shown` begins with the result's column `origin`, and columns count from there. `first`: the cut at which the path
  /// begins, and also ends; no_cut: it begins and ends anywhere.
  PathSearch(const CourseLabels& labels, const CourseFit& fit, const std::vector<ColumnDescriptor>& shown,
             const CourseCosts& prices, int origin, CutIndex first)
      : labels_(labels),
        fit_(fit),
        shown_(shown),
        cut_prices_(prices.cuts),
        origin_(origin),
        first_(first),
        cut_count_(labels.cuts.size()),
        changes_(shown.size() + 1),
        price_(size_t(labels.count()), 0),
        column_cost_(size_t(labels.count()), 0),
        cost_(size_t(labels.count()), impossible),
        start_cost_(cut_count_, impossible),
        previous_cut_(shown.size() * cut_count_, no_cut) {
    for (const ColumnPrice& p : prices.columns) {
      if (p.end <= 0 || p.begin >= length()) continue;
      const auto label = size_t(labels.begin(p.course) + p.column);
      changes_[size_t(std::max(0, p.begin))].push_back({label, p.price});
      changes_[size_t(std::min(length(), p.end))].push_back({label, -p.price});
    }
    std::vector<int32_t> next(cost_.size());
    for (int x = 0; x < length(); x++) {
      for (const auto& [label, by] : changes_[size_t(x)]) price_[label] += by;
      start_runs(x);
      for (int c = 0; c < labels.courses(); c++) extend_runs(x, c, next);
      cost_.swap(next);
    }
  }

  /// Ascending; empty if there is no path.
  std::vector<CourseRun> runs() const {
    std::vector<CourseRun> out;
    int label = cheapest_end();
    for (int x = length() - 1; label >= 0; x--) {
      const CutIndex k = labels_.cut_at[size_t(label)];
      const CutIndex from = k == no_cut ? no_cut : previous_cut_[size_t(x) * cut_count_ + k];
      if (x == 0 || from != no_cut) out.push_back(labels_.run(x, label));
      if (x == 0) break;
      label = from != no_cut ? last_before(labels_.cuts[from]) : previous(labels_.course_of(label), label);
    }
    std::ranges::reverse(out);
    return out;
  }

 private:
  int length() const { return int(shown_.size()); }
  /// The label that one goes on from, and the last one of a run that ends before a cut; -1: none.
  int previous(int course, int label) const { return labels_.before(course, label, fit_.step); }
  int last_before(const CourseLabels::Cut& cut) const { return previous(cut.course, cut.label); }

  /// The cost of showing each label of a course in column x.
  void price_columns(int x, int course) {
    const CourseColumns& columns = *labels_.course(course).columns;
    const ColumnDescriptor shown = shown_[size_t(x)];
    const auto begin = size_t(labels_.begin(course));
    for (size_t u = 0; u < columns.looks.size(); u++) column_cost_[begin + u] = difference(shown, columns.looks[u]);
    const double per_difference = fit_.per_difference;
    const int32_t most = fit_.most_difference;
    for (size_t u = 0; u < columns.looks.size(); u++) {
      const int32_t cost = std::min(most, int32_t(column_cost_[begin + u] * per_difference)) + price_[begin + u];
      column_cost_[begin + u] = columns.usable[u] ? cost : forbidden;
    }
  }

  /// The cost of the cheapest path to each label of a course in column x.
  void extend_runs(int x, int course, std::vector<int32_t>& next) {
    price_columns(x, course);
    const int begin = labels_.begin(course), end = labels_.end(course), step = fit_.step;
    const auto go_on = [&](int l, int32_t cost) {
      next[size_t(l)] = cost < impossible ? cost + column_cost_[size_t(l)] : impossible;
    };
    const int first_after = x > 0 ? std::min(end, begin + step) : end;
    for (int l = begin; l < first_after; l++) {
      const int from = x > 0 ? previous(course, l) : -1;
      const bool begins = x == 0 && first_ == no_cut && in_phase(x, course, l);
      go_on(l, from >= 0 ? cost_[size_t(from)] : begins ? 0 : impossible);
    }
    for (int l = first_after; l < end; l++) go_on(l, cost_[size_t(l - step)]);
    for (int k = labels_.cuts_begin(course); k < labels_.cuts_end(course); k++) {
      const int label = labels_.cuts[size_t(k)].label;
      const int32_t start = start_cost_[size_t(k)];
      if (start < impossible && start + column_cost_[size_t(label)] < next[size_t(label)])
        next[size_t(label)] = start + column_cost_[size_t(label)];
      else
        previous_cut_[size_t(x) * cut_count_ + size_t(k)] = no_cut;
    }
  }
  /// The cost of a path whose last run ends before a cut, and of that cut.
  int32_t end_cost(size_t k) const {
    const CourseLabels::Cut& cut = labels_.cuts[k];
    const int last = last_before(cut);
    const bool possible = last >= 0 && cost_[size_t(last)] < impossible;
    return possible ? cost_[size_t(last)] + cut.cost : impossible;
  }

  /// Starts runs in column x: in another course, or forward or far back in the course of the run before.
  void start_runs(int x) {
    if (x == 0) {
      if (first_ != no_cut) start_cost_[first_] = labels_.cuts[first_].cost;
      return;
    }
    std::vector<int32_t> ends(cut_count_);
    for (size_t k = 0; k < cut_count_; k++) ends[k] = end_cost(k);
    // The cheapest ends in each course, in those before it, and in those behind it.
    const auto courses = size_t(labels_.courses());
    std::vector<CheapestEnds> of(courses, CheapestEnds(fit_.per_gap)), before = of, behind = of;
    for (int c = 0; c < labels_.courses(); c++)
      for (int k = labels_.cuts_begin(c); k < labels_.cuts_end(c); k++) consider_end(k, ends, of[size_t(c)]);
    for (size_t c = 1; c < courses; c++) {
      before[c] = before[c - 1];
      before[c].consider(of[c - 1]);
      behind[courses - 1 - c] = behind[courses - c];
      behind[courses - 1 - c].consider(of[courses - c]);
    }
    for (int c = 0; c < labels_.courses(); c++) start_in_course(x, c, before[size_t(c)], behind[size_t(c)], ends);
  }
  void consider_end(int k, const std::vector<int32_t>& ends, CheapestEnds& to) const {
    to.consider(ends[size_t(k)], CutIndex(k), labels_.cuts[size_t(k)].joint_offset);
  }

  void start_in_course(int x, int course, const CheapestEnds& before, const CheapestEnds& behind,
                       const std::vector<int32_t>& ends) {
    const int begin = labels_.cuts_begin(course), end = labels_.cuts_end(course);
    const int32_t price = cut_prices_.empty() ? 0 : cut_prices_[size_t(x)];
    std::vector<Cheapest> from(size_t(end - begin));
    // Far enough on in a closed course is back again: ends in its first half are considered apart there.
    const int length = labels_.length(course), half = labels_.begin(course) + length / 2;
    const auto comes_back = [&](int k) {
      return labels_.closed(course) &&
             labels_.cuts[size_t(k)].label - labels_.begin(course) + least_step_back(course) > length;
    };
    CheapestEnds onward(fit_.per_gap), of_second_half = onward, back = onward, around = onward;
    int last_of_half = begin - 1;
    for (int k = begin; k < end; k++) {
      Cheapest& best = from[size_t(k - begin)];
      for (const CheapestEnds* l : {&before, &behind, comes_back(k) ? &std::as_const(of_second_half) : &onward})
        best.consider(l->to(labels_.cuts[size_t(k)].joint_offset));
      consider_end(k, ends, onward);
      if (labels_.cuts[size_t(k)].label >= half)
        consider_end(k, ends, of_second_half);
      else
        last_of_half = k;
    }
    for (int k = end - 1, far = end - 1, near = last_of_half; k >= begin; k--) {
      for (; far >= begin && goes_back(far, k); far--) consider_end(far, ends, back);
      from[size_t(k - begin)].consider(back.to(labels_.cuts[size_t(k)].joint_offset));
      if (!comes_back(k)) continue;
      for (; near >= begin && goes_back(near, k, length); near--) consider_end(near, ends, around);
      from[size_t(k - begin)].consider(around.to(labels_.cuts[size_t(k)].joint_offset));
    }
    for (int k = begin; k < end; k++) {
      const Cheapest& c = from[size_t(k - begin)];
      const CourseLabels::Cut& cut = labels_.cuts[size_t(k)];
      const bool begins = c.cost < impossible && cut.label < labels_.end(course) && in_phase(x, course, cut.label);
      start_cost_[size_t(k)] = begins ? c.cost + cut.cost + price : impossible;
      previous_cut_[size_t(x) * cut_count_ + size_t(k)] = c.cut;
    }
  }
  bool in_phase(int x, int course, int label) const {
    return labels_.course(course).fits(label - labels_.begin(course) - (origin_ + x) * fit_.step);
  }
  int least_step_back(int course) const {
    return labels_.closed(course) ? std::min(fit_.least_step_back, labels_.length(course) / 2) : fit_.least_step_back;
  }
  /// Whether a cut lies far enough behind another one of its course; `around`: once around it.
  bool goes_back(int from, int to, int around = 0) const {
    const CourseLabels::Cut& cut = labels_.cuts[size_t(from)];
    return cut.label + around - labels_.cuts[size_t(to)].label >= least_step_back(cut.course);
  }
  /// Whether a run may begin at a cut after one that ends at another, or goes on from it.
  bool may_follow(int from, int to) const {
    const CourseLabels::Cut &a = labels_.cuts[size_t(from)], &b = labels_.cuts[size_t(to)];
    if (a.course != b.course || a.label == b.label || goes_back(from, to)) return true;
    return a.label < b.label && (!labels_.closed(a.course) || goes_back(from, to, labels_.length(a.course)));
  }

  /// The label with which the cheapest path ends; -1 if there is none.
  int cheapest_end() const {
    int out = -1;
    int64_t least = impossible;
    const auto consider = [&](int64_t cost, int label) {
      if (cost >= least) return;
      least = cost;
      out = label;
    };
    if (first_ == no_cut)
      for (int l = 0; l < labels_.count(); l++) consider(cost_[size_t(l)], l);
    for (size_t k = 0; first_ != no_cut && k < cut_count_; k++)
      if (may_follow(int(k), first_)) {
        const CourseLabels::Cut& cut = labels_.cuts[k];
        const int gap = std::abs(cut.joint_offset - labels_.cuts[first_].joint_offset);
        consider(end_cost(k) + int64_t{fit_.per_gap} * gap, last_before(cut));
      }
    return out;
  }

  const CourseLabels& labels_;
  const CourseFit& fit_;
  const std::vector<ColumnDescriptor>& shown_;
  const std::vector<int32_t>& cut_prices_;
  int origin_;
  CutIndex first_;
  size_t cut_count_;
  std::vector<std::vector<std::pair<size_t, int32_t>>> changes_;  // of prices, in each column of the result
  std::vector<int32_t> price_;                                    // of each label, in the column at hand
  std::vector<int32_t> column_cost_;                              // of showing each label there
  std::vector<int32_t> cost_;                                     // of the cheapest path to each label
  std::vector<int32_t> start_cost_;                               // the same to each cut at which a run may begin
  std::vector<CutIndex> previous_cut_;  // of each column and cut: the one before it; no_cut: no run begins there
};

/// Runs of a result that wraps. In a path twice around, a cut in the middle does not depend on the ends. A second path
/// begins and ends there.
std::vector<CourseRun> runs_around(const CourseLabels& labels, const CourseFit& fit,
                                   const std::vector<ColumnDescriptor>& shown, const CourseCosts& prices) {
  const int length = int(shown.size());
  const auto path = [&](int from, int times, CutIndex first) {
    std::vector<ColumnDescriptor> looks;
    CourseCosts moved;
    for (int x = from; x < from + times * length; x++) {
      looks.push_back(shown[size_t(x % length)]);
      if (!prices.cuts.empty()) moved.cuts.push_back(prices.cuts[size_t(x % length)]);
    }
    for (int turn = -1; turn <= times; turn++)
      for (ColumnPrice p : prices.columns) {
        p.begin += turn * length - from;
        p.end += turn * length - from;
        moved.columns.push_back(p);
      }
    return PathSearch(labels, fit, looks, moved, from, first).runs();
  };
  std::vector<CourseRun> twice = path(0, 2, no_cut);
  if (twice.empty()) return {};
  auto middle = std::ranges::find_if(twice, [&](const CourseRun& r) { return r.begin >= length / 2; });
  if (middle == twice.end() || middle->begin >= length / 2 + length) {
    // Nothing is cut there: a closed course goes around, at no cost if it meets itself, else by its cheapest cut.
    const CourseRun& going = *(middle - 1);
    if (!labels.closed(going.course) || labels.cuts_begin(going.course) == labels.cuts_end(going.course)) return {};
    if (length * fit.step % labels.length(going.course) == 0) {
      const int ahead = (going.begin / length + 1) * length - going.begin;
      return {{0, going.course, (going.from + ahead * fit.step) % labels.length(going.course)}};
    }
    const auto cheapest =
        std::ranges::min_element(labels.cuts.begin() + labels.cuts_begin(going.course),
                                 labels.cuts.begin() + labels.cuts_end(going.course), {}, &CourseLabels::Cut::cost);
    const int from = cheapest->label - labels.begin(going.course);
    const int ahead = wrap(from - going.from, labels.length(going.course)) / fit.step;
    *(middle = twice.begin()) = {going.begin + ahead, going.course, from};
  }
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

std::vector<CourseRun> fitting_runs(const std::vector<ColumnDescriptor>& shown,
                                    const std::vector<CandidateCourse>& courses, const CourseCosts& prices,
                                    const CourseFit& fit) {
  const CourseLabels labels(courses);
  return fit.closed ? runs_around(labels, fit, shown, prices)
                    : PathSearch(labels, fit, shown, prices, 0, no_cut).runs();
}

}  // namespace terrazzo
