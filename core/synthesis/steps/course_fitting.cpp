#include "core/synthesis/steps/course_fitting.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
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

/// Values per label or cut for the last few columns of the result.
template <class T>
class Recent {
 public:
  Recent(int columns, size_t values, T value) : values_(size_t(columns), std::vector<T>(values, value)) {}
  std::vector<T>& at(int x) { return values_[size_t(x) % values_.size()]; }
  const std::vector<T>& at(int x) const { return values_[size_t(x) % values_.size()]; }

 private:
  std::vector<std::vector<T>> values_;
};

/// Finds the cheapest path through the result, from its first column to its last. A run is short until it reaches the
/// minimum length, and complete from then on: only complete runs may end, but for the result's borders. As the minimum
/// length is the same for all, short runs need no states of their own: what they cost is a difference of sums.
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
        complete_(size_t(labels.count()), impossible),
        sums_(fit.shortest + 1, size_t(labels.count()), 0),
        start_cost_(fit.shortest + 1, cut_count_, impossible),
        previous_cut_(shown.size() * cut_count_, no_cut),
        completes_(shown.size() * cut_count_, 0) {
    for (const ColumnPrice& p : prices.columns) {
      if (p.end <= 0 || p.begin >= length()) continue;
      const auto label = size_t(labels.begin(p.course) + p.column);
      changes_[size_t(std::max(0, p.begin))].push_back({label, p.price});
      changes_[size_t(std::min(length(), p.end))].push_back({label, -p.price});
    }
    std::vector<int32_t> next(complete_.size());
    for (int x = 0; x < length(); x++) {
      for (const auto& [label, by] : changes_[size_t(x)]) price_[label] += by;
      start_runs(x);
      for (int c = 0; c < labels.courses(); c++) extend_runs(x, c, next);
      complete_.swap(next);
    }
  }

  /// Ascending; empty if there is no path.
  std::vector<CourseRun> runs() const {
    std::vector<CourseRun> out;
    const std::optional<End> end = cheapest_end();
    if (!end) return out;
    int x = length() - 1, label = end->label;
    CutIndex began = end->short_since;
    int began_at = x - end->short_columns + 1;
    for (;;) {
      if (began == no_cut) {
        const CutIndex k = labels_.completed_from[size_t(label)];
        if (k != no_cut && completes_[size_t(x) * cut_count_ + k]) {
          began = k;
          began_at = x - fit_.shortest + 1;
        } else if (x == 0) {
          out.push_back(labels_.run(0, label));
          break;
        } else {
          x--;
          label = previous(labels_.course_of(label), label);
          continue;
        }
      }
      out.push_back(labels_.run(began_at, labels_.cuts[began].label));
      const CutIndex from = began_at > 0 ? previous_cut_[size_t(began_at) * cut_count_ + began] : no_cut;
      if (from == no_cut) break;
      x = began_at - 1;
      label = last_before(labels_.cuts[from]);
      began = no_cut;
    }
    std::ranges::reverse(out);
    return out;
  }

 private:
  struct End {
    int label = 0;
    CutIndex short_since = no_cut;  // the cut at which a run began that the result's border cuts short,
    int short_columns = 0;          // and its columns
  };

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

  /// The cost of the cheapest path to each label of a course in column x, in a complete run.
  void extend_runs(int x, int course, std::vector<int32_t>& next) {
    price_columns(x, course);
    const int begin = labels_.begin(course), end = labels_.end(course), step = fit_.step;
    int64_t* sum = sums_.at(x).data();
    const int64_t* sum_before = x > 0 ? sums_.at(x - 1).data() : nullptr;
    const int first_after = x > 0 ? std::min(end, begin + step) : end;
    const auto go_on = [&](int l, int from) {
      const int32_t cost = complete_[size_t(from)];
      sum[l] = sum_before[from] + column_cost_[size_t(l)];
      next[size_t(l)] = cost < impossible ? cost + column_cost_[size_t(l)] : impossible;
    };
    for (int l = begin; l < first_after; l++) {
      if (const int from = x > 0 ? previous(course, l) : -1; from >= 0) {
        go_on(l, from);
        continue;
      }
      sum[l] = column_cost_[size_t(l)];
      next[size_t(l)] = x == 0 && first_ == no_cut && in_phase(x, course, l) ? column_cost_[size_t(l)] : impossible;
    }
    for (int l = first_after; l < end; l++) go_on(l, l - step);
    if (x >= fit_.shortest - 1) complete_runs(x, course, next);
  }

  /// Adds the runs that reach the minimum length in column x.
  void complete_runs(int x, int course, std::vector<int32_t>& next) {
    for (int k = labels_.cuts_begin(course); k < labels_.cuts_end(course); k++) {
      const int label = labels_.after(labels_.cuts[size_t(k)], (fit_.shortest - 1) * fit_.step);
      if (label < 0) continue;
      const int64_t cost = short_cost(x, CutIndex(k), fit_.shortest);
      if (cost >= next[size_t(label)]) continue;
      next[size_t(label)] = int32_t(cost);
      completes_[size_t(x) * cut_count_ + size_t(k)] = 1;
    }
  }

  /// The cost of a path whose last run began at a cut and has shown `columns` columns, up to x.
  int64_t short_cost(int x, CutIndex k, int columns) const {
    const int32_t start = start_cost_.at(x - columns + 1)[k];
    if (start >= impossible) return impossible;
    const CourseLabels::Cut& cut = labels_.cuts[k];
    const int from = x >= columns ? last_before(cut) : -1;
    return start + sums_.at(x)[size_t(labels_.after(cut, (columns - 1) * fit_.step))] -
           (from >= 0 ? sums_.at(x - columns)[size_t(from)] : 0);
  }

  /// The cost of a path whose last run ends before a cut, and of that cut.
  int32_t end_cost(size_t k) const {
    const CourseLabels::Cut& cut = labels_.cuts[k];
    const int last = last_before(cut);
    const bool possible = last >= 0 && complete_[size_t(last)] < impossible;
    return possible ? complete_[size_t(last)] + cut.cost : impossible;
  }

  /// Starts runs in column x: in another course, or forward or far back in the course of the run before.
  void start_runs(int x) {
    std::vector<int32_t>& start = start_cost_.at(x);
    if (x == 0) {
      std::ranges::fill(start, impossible);
      if (first_ != no_cut) start[first_] = labels_.cuts[first_].cost;
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
      start_cost_.at(x)[size_t(k)] = begins ? c.cost + cut.cost + price : impossible;
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

  std::optional<End> cheapest_end() const {
    std::optional<End> out;
    int64_t least = impossible;
    const auto consider = [&](int64_t cost, const End& end) {
      if (cost >= least) return;
      least = cost;
      out = end;
    };
    if (first_ != no_cut) {
      const CourseLabels::Cut& first = labels_.cuts[first_];
      for (size_t k = 0; k < cut_count_; k++) {
        const CourseLabels::Cut& cut = labels_.cuts[k];
        if (may_follow(int(k), first_))
          consider(end_cost(k) + int64_t{fit_.per_gap} * std::abs(cut.joint_offset - first.joint_offset),
                   {last_before(cut)});
      }
      return out;
    }
    for (int l = 0; l < labels_.count(); l++) consider(complete_[size_t(l)], {l});
    for (int columns = 1; columns < std::min(fit_.shortest, length()); columns++)
      for (size_t k = 0; k < cut_count_; k++) {
        const CourseLabels::Cut& cut = labels_.cuts[k];
        if (const int label = labels_.after(cut, (columns - 1) * fit_.step); label >= 0)
          consider(short_cost(length() - 1, CutIndex(k), columns), {label, CutIndex(k), columns});
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
  std::vector<int32_t> complete_;       // the cost of the cheapest path to each label in a complete run
  Recent<int64_t> sums_;                // of column costs along labels that continue one another
  Recent<int32_t> start_cost_;          // the cost of the cheapest path that starts a run at each cut
  std::vector<CutIndex> previous_cut_;  // of each column and cut, at which a run starts: the one before it
  std::vector<uint8_t> completes_;      // of each column and cut: whether its run is the cheapest once it is complete
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
  const CourseLabels labels(courses, fit);
  return fit.closed ? runs_around(labels, fit, shown, prices)
                    : PathSearch(labels, fit, shown, prices, 0, no_cut).runs();
}

}  // namespace terrazzo
