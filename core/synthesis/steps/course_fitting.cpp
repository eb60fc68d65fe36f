#include "core/synthesis/steps/course_fitting.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/analysis/space/padded_level.h"

namespace terrazzo {

namespace {

constexpr int32_t impossible = 1 << 30;
constexpr int32_t forbidden = 1 << 24;  // to show a column
using CutIndex = uint16_t;
constexpr CutIndex no_cut = std::numeric_limits<CutIndex>::max();

/// The columns and the cuts of all courses, one course after the other: a label is a column's place among all.
class Labels {
 public:
  struct Cut {
    int course, label;
    int32_t cost;
    int off_middle;
  };

  Labels(const std::vector<TriedCourse>& courses, const CourseFit& fit) : courses_(courses) {
    for (size_t c = 0; c < courses.size(); c++) {
      columns_begin_.push_back(count_);
      cuts_begin_.push_back(int(cuts.size()));
      for (const CourseColumns::Cut& cut : courses[c].columns->cuts)
        cuts.push_back({int(c), count_ + cut.column, cut.cost, cut.off_middle});
      count_ += int(courses[c].columns->looks.size());
    }
    if (cuts.size() >= no_cut) throw std::length_error("more cuts than can be told apart");
    columns_begin_.push_back(count_);
    cuts_begin_.push_back(int(cuts.size()));
    long_enough_since.assign(size_t(count_), no_cut);
    for (size_t k = 0; k < cuts.size(); k++) {
      const int label = cuts[k].label + (fit.shortest - 1) * fit.step;
      if (label < end(cuts[k].course)) long_enough_since[size_t(label)] = CutIndex(k);
    }
  }

  int count() const { return count_; }
  int courses() const { return int(courses_.size()); }
  const TriedCourse& course(int c) const { return courses_[size_t(c)]; }
  int begin(int course) const { return columns_begin_[size_t(course)]; }
  int end(int course) const { return columns_begin_[size_t(course) + 1]; }
  int cuts_begin(int course) const { return cuts_begin_[size_t(course)]; }
  int cuts_end(int course) const { return cuts_begin_[size_t(course) + 1]; }
  CourseRun run(int x, int label) const {
    const int c =
        int(std::upper_bound(columns_begin_.begin(), columns_begin_.end(), label) - columns_begin_.begin()) - 1;
    return {x, c, label - begin(c)};
  }

  std::vector<Cut> cuts;
  /// Of each label the cut with which a run began that is just long enough there.
  std::vector<CutIndex> long_enough_since;

 private:
  const std::vector<TriedCourse>& courses_;
  int count_ = 0;
  std::vector<int> columns_begin_, cuts_begin_;
};

/// The cheapest cut of some.
struct Cheapest {
  int32_t cost = impossible;
  CutIndex cut = no_cut;
  void consider(const Cheapest& other) {
    if (other.cost < cost) *this = other;
  }
};

/// The cheapest cuts to leave a course by, for each part of a joint to go on with.
class Leaving {
 public:
  explicit Leaving(int32_t per_gap) : per_gap_(per_gap) {}
  void consider(int32_t cost, CutIndex k, int off_middle) {
    if (cost >= impossible) return;
    for (int to = -farthest; to <= farthest; to++)
      by_part_[size_t(to + farthest)].consider({cost + per_gap_ * std::abs(off_middle - to), k});
  }
  void consider(const Leaving& other) {
    for (size_t part = 0; part < by_part_.size(); part++) by_part_[part].consider(other.by_part_[part]);
  }
  const Cheapest& to(int off_middle) const { return by_part_[size_t(off_middle + farthest)]; }

 private:
  static constexpr int farthest = CourseColumns::farthest_off_middle;
  int32_t per_gap_;
  std::array<Cheapest, 2 * farthest + 1> by_part_;
};

/// The last so many columns of the result, each with a value per label or cut.
template <class T>
class Recent {
 public:
  Recent(int columns, size_t values, T value) : values_(size_t(columns), std::vector<T>(values, value)) {}
  std::vector<T>& at(int x) { return values_[size_t(x) % values_.size()]; }
  const std::vector<T>& at(int x) const { return values_[size_t(x) % values_.size()]; }

 private:
  std::vector<std::vector<T>> values_;
};

/// One way through the result, from its first column to its last. Runs are young until they are long enough to end.
class Way {
 public:
  /// `shown` begins with the result's column `origin`. `first`: the cut to begin with, which is where the way ends,
  /// too; no_cut: begins and ends anywhere.
  Way(const Labels& labels, const CourseFit& fit, const std::vector<ColumnLook>& shown,
      const std::vector<ColumnPrice>& prices, int origin, CutIndex first)
      : labels_(labels),
        fit_(fit),
        shown_(shown),
        origin_(origin),
        first_(first),
        cut_count_(labels.cuts.size()),
        changes_(shown.size() + 1),
        price_(size_t(labels.count()), 0),
        unlike_(size_t(labels.count()), 0),
        grown_(size_t(labels.count()), impossible),
        sums_(fit.shortest + 1, size_t(labels.count()), 0),
        entered_(fit.shortest + 1, cut_count_, impossible),
        from_(shown.size() * cut_count_, no_cut),
        grew_(shown.size() * cut_count_, 0) {
    for (const ColumnPrice& p : prices) {
      if (p.end <= 0 || p.begin >= length()) continue;
      const auto label = size_t(labels.begin(p.course) + p.column);
      changes_[size_t(std::max(0, p.begin))].push_back({label, p.price});
      changes_[size_t(std::min(length(), p.end))].push_back({label, -p.price});
    }
    std::vector<int32_t> next(grown_.size());
    for (int x = 0; x < length(); x++) {
      for (const auto& [label, by] : changes_[size_t(x)]) price_[label] += by;
      enter(x);
      for (int c = 0; c < labels.courses(); c++) go_on(x, c, next);
      grown_.swap(next);
    }
  }

  std::vector<CourseRun> runs() const {
    std::vector<CourseRun> out;
    const std::optional<End> end = cheapest_end();
    if (!end) return out;
    int x = length() - 1, label = end->label;
    CutIndex began = end->young_since;
    int began_at = x - end->young_for + 1;
    for (;;) {
      if (began == no_cut) {
        const CutIndex k = labels_.long_enough_since[size_t(label)];
        if (k != no_cut && grew_[size_t(x) * cut_count_ + k]) {
          began = k;
          began_at = x - fit_.shortest + 1;
        } else if (x == 0) {
          out.push_back(labels_.run(0, label));
          break;
        } else {
          x--;
          label -= fit_.step;
          continue;
        }
      }
      out.push_back(labels_.run(began_at, labels_.cuts[began].label));
      const CutIndex from = began_at > 0 ? from_[size_t(began_at) * cut_count_ + began] : no_cut;
      if (from == no_cut) break;
      x = began_at - 1;
      label = labels_.cuts[from].label - fit_.step;
      began = no_cut;
    }
    std::ranges::reverse(out);
    return out;
  }

 private:
  struct End {
    int label = 0;
    CutIndex young_since = no_cut;  // of a run that the end cuts off before it is long enough,
    int young_for = 0;              // the columns that it has
  };

  int length() const { return int(shown_.size()); }

  /// What each label of a course costs in a column.
  void price_labels(int x, int course) {
    const CourseColumns& columns = *labels_.course(course).columns;
    const ColumnLook shown = shown_[size_t(x)];
    const auto begin = size_t(labels_.begin(course));
    for (size_t u = 0; u < columns.looks.size(); u++) unlike_[begin + u] = difference(shown, columns.looks[u]);
    const double per_difference = fit_.per_difference;
    const int32_t most = fit_.most_incoherent;
    for (size_t u = 0; u < columns.looks.size(); u++) {
      const int32_t cost = std::min(most, int32_t(unlike_[begin + u] * per_difference)) + price_[begin + u];
      unlike_[begin + u] = columns.usable[u] ? cost : forbidden;
    }
  }

  /// What it costs to have come to each label of a course, in a run that is long enough.
  void go_on(int x, int course, std::vector<int32_t>& next) {
    price_labels(x, course);
    const int begin = labels_.begin(course), end = labels_.end(course), step = fit_.step;
    int64_t* sum = sums_.at(x).data();
    const int64_t* sum_before = x > 0 ? sums_.at(x - 1).data() : nullptr;
    const int first_after = x > 0 ? std::min(end, begin + step) : end;
    for (int l = begin; l < first_after; l++) {
      sum[l] = unlike_[size_t(l)];
      next[size_t(l)] = x == 0 && first_ == no_cut && in_phase(x, course, l) ? unlike_[size_t(l)] : impossible;
    }
    for (int l = first_after; l < end; l++) {
      const int32_t before = grown_[size_t(l - step)];
      sum[l] = sum_before[l - step] + unlike_[size_t(l)];
      next[size_t(l)] = before < impossible ? before + unlike_[size_t(l)] : impossible;
    }
    if (x >= fit_.shortest - 1) grow_up(x, course, next);
  }

  /// Runs that have just become long enough.
  void grow_up(int x, int course, std::vector<int32_t>& next) {
    for (int k = labels_.cuts_begin(course); k < labels_.cuts_end(course); k++) {
      const int label = labels_.cuts[size_t(k)].label + (fit_.shortest - 1) * fit_.step;
      if (label >= labels_.end(course)) continue;
      const int64_t young = young_cost(x, CutIndex(k), fit_.shortest);
      if (young >= next[size_t(label)]) continue;
      next[size_t(label)] = int32_t(young);
      grew_[size_t(x) * cut_count_ + size_t(k)] = 1;
    }
  }

  /// What it costs to have shown `columns` from a cut on, up to x.
  int64_t young_cost(int x, CutIndex k, int columns) const {
    const int32_t entered = entered_.at(x - columns + 1)[k];
    if (entered >= impossible) return impossible;
    const Labels::Cut& cut = labels_.cuts[k];
    const int before = cut.label - fit_.step;
    const bool has_before = before >= labels_.begin(cut.course) && x >= columns;
    return entered + sums_.at(x)[size_t(cut.label + (columns - 1) * fit_.step)] -
           (has_before ? sums_.at(x - columns)[size_t(before)] : 0);
  }

  /// What it costs to leave what lies before each cut.
  int32_t leaving(size_t k) const {
    const Labels::Cut& cut = labels_.cuts[k];
    const int last = cut.label - fit_.step;
    const bool possible = last >= labels_.begin(cut.course) && grown_[size_t(last)] < impossible;
    return possible ? grown_[size_t(last)] + cut.cost : impossible;
  }

  /// A run may go over to another course, or on or far back in its own.
  void enter(int x) {
    std::vector<int32_t>& enter = entered_.at(x);
    if (x == 0) {
      std::ranges::fill(enter, impossible);
      if (first_ != no_cut) enter[first_] = labels_.cuts[first_].cost;
      return;
    }
    std::vector<int32_t> leave(cut_count_);
    for (size_t k = 0; k < cut_count_; k++) leave[k] = leaving(k);
    // Of each course, of those before each, and of those behind it.
    const auto courses = size_t(labels_.courses());
    std::vector<Leaving> of(courses, Leaving(fit_.per_gap)), before = of, behind = of;
    for (int c = 0; c < labels_.courses(); c++)
      for (int k = labels_.cuts_begin(c); k < labels_.cuts_end(c); k++) consider_cut(k, leave, of[size_t(c)]);
    for (size_t c = 1; c < courses; c++) {
      before[c] = before[c - 1];
      before[c].consider(of[c - 1]);
      behind[courses - 1 - c] = behind[courses - c];
      behind[courses - 1 - c].consider(of[courses - c]);
    }
    for (int c = 0; c < labels_.courses(); c++) enter_course(x, c, before[size_t(c)], behind[size_t(c)], leave);
  }
  void consider_cut(int k, const std::vector<int32_t>& leave, Leaving& to) const {
    to.consider(leave[size_t(k)], CutIndex(k), labels_.cuts[size_t(k)].off_middle);
  }

  void enter_course(int x, int course, const Leaving& before, const Leaving& behind,
                    const std::vector<int32_t>& leave) {
    const int begin = labels_.cuts_begin(course), end = labels_.cuts_end(course);
    std::vector<Cheapest> from(size_t(end - begin));
    Leaving onward(fit_.per_gap), back(fit_.per_gap);
    for (int k = begin; k < end; k++) {
      Cheapest& best = from[size_t(k - begin)];
      for (const Leaving* l : {&before, &behind, &std::as_const(onward)})
        best.consider(l->to(labels_.cuts[size_t(k)].off_middle));
      consider_cut(k, leave, onward);
    }
    for (int k = end - 1, far = end - 1; k >= begin; k--) {
      for (; far >= begin && goes_back(far, k); far--) consider_cut(far, leave, back);
      from[size_t(k - begin)].consider(back.to(labels_.cuts[size_t(k)].off_middle));
    }
    for (int k = begin; k < end; k++) {
      const Cheapest& c = from[size_t(k - begin)];
      const Labels::Cut& cut = labels_.cuts[size_t(k)];
      entered_.at(x)[size_t(k)] = c.cost < impossible && can_begin(x, cut) ? c.cost + cut.cost : impossible;
      from_[size_t(x) * cut_count_ + size_t(k)] = c.cut;
    }
  }
  bool can_begin(int x, const Labels::Cut& cut) const {
    return cut.label < labels_.end(cut.course) && in_phase(x, cut.course, cut.label);
  }
  bool in_phase(int x, int course, int label) const {
    return labels_.course(course).fits(label - labels_.begin(course) - (origin_ + x) * fit_.step);
  }
  bool goes_back(int from, int to) const {
    return labels_.cuts[size_t(from)].label - labels_.cuts[size_t(to)].label >= fit_.again;
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
      const Labels::Cut& first = labels_.cuts[first_];
      for (size_t k = 0; k < cut_count_; k++) {
        const Labels::Cut& cut = labels_.cuts[k];
        if (cut.course != first.course || cut.label <= first.label || goes_back(int(k), first_))
          consider(leaving(k) + int64_t{fit_.per_gap} * std::abs(cut.off_middle - first.off_middle),
                   {cut.label - fit_.step});
      }
      return out;
    }
    for (int l = 0; l < labels_.count(); l++) consider(grown_[size_t(l)], {l});
    for (int columns = 1; columns < std::min(fit_.shortest, length()); columns++)
      for (size_t k = 0; k < cut_count_; k++) {
        const Labels::Cut& cut = labels_.cuts[k];
        const int label = cut.label + (columns - 1) * fit_.step;
        if (label < labels_.end(cut.course))
          consider(young_cost(length() - 1, CutIndex(k), columns), {label, CutIndex(k), columns});
      }
    return out;
  }

  const Labels& labels_;
  const CourseFit& fit_;
  const std::vector<ColumnLook>& shown_;
  int origin_;
  CutIndex first_;
  size_t cut_count_;
  std::vector<std::vector<std::pair<size_t, int32_t>>> changes_;  // of prices
  std::vector<int32_t> price_;                                    // now, of each label
  std::vector<int32_t> unlike_;                                   // what each costs by itself
  std::vector<int32_t> grown_;  // what each label costs at the end of a run that is long enough
  Recent<int64_t> sums_;        // of what labels have cost that follow each other
  Recent<int32_t> entered_;     // what it costs to begin a run with each cut
  std::vector<CutIndex> from_;  // of each column and cut, the cut at which the run before ended
  std::vector<uint8_t> grew_;   // whether a run that began with a cut is the best way once it is long enough
};

/// Around a result that wraps: twice around, a cut in the middle is one in which neither end has a say. Once more
/// around from there.
std::vector<CourseRun> runs_around(const Labels& labels, const CourseFit& fit, const std::vector<ColumnLook>& shown,
                                   const std::vector<ColumnPrice>& prices) {
  const int length = int(shown.size());
  const auto way = [&](int from, int times, CutIndex first) {
    std::vector<ColumnLook> looks;
    for (int x = 0; x < times * length; x++) looks.push_back(shown[size_t((x + from) % length)]);
    std::vector<ColumnPrice> moved;
    for (int turn = -1; turn <= times; turn++)
      for (ColumnPrice p : prices) {
        p.begin += turn * length - from;
        p.end += turn * length - from;
        moved.push_back(p);
      }
    return Way(labels, fit, looks, moved, from, first).runs();
  };
  const std::vector<CourseRun> twice = way(0, 2, no_cut);
  const auto middle = std::ranges::find_if(twice, [&](const CourseRun& r) { return r.begin >= length / 2; });
  if (middle == twice.end() || middle->begin >= length / 2 + length) return {};
  const auto first = std::ranges::find_if(labels.cuts, [&](const Labels::Cut& cut) {
    return cut.course == middle->course && cut.label == labels.begin(cut.course) + middle->from;
  });
  const int from = middle->begin % length;
  std::vector<CourseRun> runs = way(from, 1, CutIndex(first - labels.cuts.begin()));
  for (CourseRun& r : runs) r.begin = (r.begin + from) % length;
  std::ranges::sort(runs, {}, &CourseRun::begin);
  return runs;
}

}  // namespace

int32_t difference(const ColumnLook& a, const ColumnLook& b) {
  int32_t sum = 0;
  for (size_t s = 0; s < a.size(); s++) sum += squared_distance(a[s], b[s]) >> 3;
  return sum;
}

std::vector<CourseRun> fitting_runs(const std::vector<ColumnLook>& shown, const std::vector<TriedCourse>& courses,
                                    const std::vector<ColumnPrice>& prices, const CourseFit& fit) {
  const Labels labels(courses, fit);
  return fit.closed ? runs_around(labels, fit, shown, prices) : Way(labels, fit, shown, prices, 0, no_cut).runs();
}

}  // namespace terrazzo
