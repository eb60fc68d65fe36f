#include "core/metrics/whole_elements.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/base/tuning.h"
#include "core/numeric/distance_transform.h"
#include "core/numeric/watershed.h"

namespace terrazzo {

namespace {

struct WholeElementsTuning {
  double joint = 0.3;
  double alone = 0.85;
  double most_of_it = 0.75;
  double least_whole = 0.6;
  double least_whole_in_heaps = 0.45;
  double most_missing = 0.5;
  int samples = 12;
};
const Tunable<WholeElementsTuning> whole_elements_tuning(
    "whole_elements",
    {{&WholeElementsTuning::joint, "joint", "inner radii",
      "from a region's border that count as its joint. Higher: two elements that touch are told apart; lower: narrow "
      "elements do not fall apart",
      "whole_elements", 0, 0.9},
     {&WholeElementsTuning::alone, "alone", "share of an element of the result",
      "that must show one of the exemplar for it to be whole", "whole_elements", 0, 1},
     {&WholeElementsTuning::most_of_it, "most_of_it", "share of an element of the exemplar",
      "that must be shown for it to be whole", "whole_elements", 0, 1},
     {&WholeElementsTuning::least_whole, "least_whole", "share of all elements",
      "below which a result is doubted. Higher: good results are doubted as well; lower: bad ones pass",
      "whole_elements", 0, 1},
     {&WholeElementsTuning::least_whole_in_heaps, "least_whole_in_heaps", "share of all elements",
      "the same where elements lie partly under others", "heaped_elements", 0, 1},
     {&WholeElementsTuning::most_missing, "most_missing", "share of the exemplar's area",
      "above which a result is doubted. Higher: results that lack much pass; lower: those that lack a corner do not",
      "whole_elements", 0, 1},
     {&WholeElementsTuning::samples, "samples", "pixels",
      "across an element's side. Higher: thin joints are found; costs time", "whole_elements", 4, 1000}});

/// For each pixel of the exemplar whether it lies inside an element, away from its joints.
std::vector<uint8_t> insides(const Elements& elements, bool wraps) {
  const std::vector<int64_t> squares =
      squared_distances(border_pixels(elements.at, elements.size, wraps), elements.size, wraps);
  std::vector<int64_t> deepest(size_t(elements.count), 1);
  for (size_t i = 0; i < squares.size(); i++) deepest[elements.at[i]] = std::max(deepest[elements.at[i]], squares[i]);
  const double joint = whole_elements_tuning->joint * whole_elements_tuning->joint;
  std::vector<uint8_t> out(squares.size());
  for (size_t i = 0; i < out.size(); i++) out[i] = double(squares[i]) > joint * double(deepest[elements.at[i]]) ? 1 : 0;
  return out;
}

/// A sample of the result's pixels, evenly spread.
struct Sample {
  Size size;
  int step;
  std::vector<ExemplarPixel> shown;

  Sample(const UvMap& uv, int s) : size{(uv.size().width + s - 1) / s, (uv.size().height + s - 1) / s}, step(s) {
    for (int y = 0; y < size.height; y++)
      for (int x = 0; x < size.width; x++) shown.push_back(uv.at(x * s, y * s));
  }
};

/// The elements of a result. Insides that meet are one element, and of those what goes on from one exemplar pixel to
/// the next is one piece.
class LaidElements {
 public:
  LaidElements(const UvMap& uv, const Elements& elements, const Task& task)
      : wraps_(uv.wraps()),
        elements_(elements),
        inside_(insides(elements, uv.wraps().exemplar)),
        sample_(uv, std::max(1, int(typical_side(elements) / whole_elements_tuning->samples))),
        result_(sample_.shown.size()),
        pieces_(sample_.shown.size()),
        torn_(sample_.shown.size(), 0) {
    task.check();
    join();
    task.check();
    measure();
    judge();
  }

  const ShownElements& shown() const { return shown_; }
  /// Whether the pixel of the result lies inside an element that is not whole.
  bool is_torn(int x, int y) {
    const size_t i = size_t(y / sample_.step) * size_t(sample_.size.width) + size_t(x / sample_.step);
    return is_inside(i) && torn_[result_.find(uint32_t(i))] != 0;
  }

 private:
  size_t at(const ExemplarPixel& p) const { return size_t(p.y) * size_t(elements_.size.width) + p.x; }
  bool is_inside(size_t sample) const { return inside_[at(sample_.shown[sample])] != 0; }

  bool goes_on(int from, int to, int step, int length) const {
    int apart = std::abs(to - from - step);
    if (wraps_.exemplar) apart = std::min(apart, length - apart);
    return apart < sample_.step;
  }

  void meet(int x, int y, int u, int v, int right, int down) {
    const auto i = uint32_t(y * sample_.size.width + x), j = uint32_t(v * sample_.size.width + u);
    const ExemplarPixel a = sample_.shown[i], b = sample_.shown[j];
    if (!is_inside(i) || !is_inside(j)) return;
    result_.join(i, j);
    if (elements_.at[at(a)] == elements_.at[at(b)] && goes_on(a.x, b.x, right * sample_.step, elements_.size.width) &&
        goes_on(a.y, b.y, down * sample_.step, elements_.size.height))
      pieces_.join(i, j);
  }

  void join() {
    const int w = sample_.size.width, h = sample_.size.height;
    for (int y = 0; y < h; y++)
      for (int x = 0; x < w; x++) {
        if (x + 1 < w || wraps_.x) meet(x, y, (x + 1) % w, y, 1, 0);
        if (y + 1 < h || wraps_.y) meet(x, y, x, (y + 1) % h, 0, 1);
      }
  }

  /// The areas of the exemplar's insides, in samples, and how much of them is missing.
  void measure() {
    areas_.assign(size_t(elements_.count), 0.0);
    for (size_t i = 0; i < inside_.size(); i++)
      if (inside_[i]) {
        areas_[elements_.at[i]] += 1.0 / (sample_.step * sample_.step);
        total_ += 1.0 / (sample_.step * sample_.step);
      }
    std::vector<uint8_t> seen(size_t(elements_.count), 0);
    for (const ExemplarPixel& p : sample_.shown)
      if (inside_[at(p)]) seen[elements_.at[at(p)]] = 1;
    for (size_t e = 0; e < seen.size(); e++)
      if (!seen[e]) shown_.missing += areas_[e] / total_;
  }

  void judge() {
    std::vector<std::pair<uint32_t, uint32_t>> parts;  // element of the result and piece
    std::vector<uint8_t> cut(sample_.shown.size(), 0);
    for (size_t i = 0; i < sample_.shown.size(); i++) {
      if (!is_inside(i)) continue;
      parts.emplace_back(result_.find(uint32_t(i)), pieces_.find(uint32_t(i)));
      const int x = int(i) % sample_.size.width, y = int(i) / sample_.size.width;
      if ((!wraps_.x && (x == 0 || x == sample_.size.width - 1)) ||
          (!wraps_.y && (y == 0 || y == sample_.size.height - 1)))
        cut[parts.back().first] = 1;
    }
    std::ranges::sort(parts);
    double area_of_all = 0;
    std::set<uint16_t> distinct;
    for (size_t i = 0; i < parts.size();) {
      const uint32_t element = parts[i].first;
      double area = 0, largest = 0;
      uint32_t piece = 0;
      while (i < parts.size() && parts[i].first == element) {
        const size_t begin = i;
        while (i < parts.size() && parts[i] == parts[begin]) i++;
        area += double(i - begin);
        if (double(i - begin) > largest) {
          largest = double(i - begin);
          piece = parts[begin].second;
        }
      }
      const uint16_t shows = elements_.at[at(sample_.shown[piece])];
      const bool of_one = largest >= whole_elements_tuning->alone * area;
      const bool whole = of_one && largest >= whole_elements_tuning->most_of_it * areas_[shows];
      // What the result's border cuts is not torn, as long as it is of one.
      torn_[element] = !whole && !(cut[element] && of_one) ? 1 : 0;
      if (cut[element] && whole) continue;
      area_of_all += area;
      if (!whole) continue;
      shown_.whole++;
      distinct.insert(shows);
    }
    shown_.distinct = int(distinct.size());
    // Torn elements are counted by their area: they are more, or, melted together, fewer than they should be.
    if (total_ > 0) shown_.all = std::max(shown_.whole, int(area_of_all / mean_area() + 0.5));
  }

  /// Of the exemplar's elements; without those that its border cuts, unless it cuts all.
  double mean_area() const {
    const std::vector<uint8_t> cut = cut_elements(elements_, wraps_.exemplar);
    double sum = 0;
    int count = 0;
    for (size_t e = 0; e < cut.size(); e++) {
      if (cut[e]) continue;
      sum += areas_[e];
      count++;
    }
    return sum > 0 ? sum / count : total_ / elements_.count;
  }

  UvWraps wraps_;
  const Elements& elements_;
  std::vector<uint8_t> inside_;
  Sample sample_;
  DisjointSets result_, pieces_;
  std::vector<uint8_t> torn_;  // by the first sample of an element of the result
  std::vector<double> areas_;
  double total_ = 0;
  ShownElements shown_;
};

}  // namespace

bool ShownElements::are_broken(bool heaped) const {
  return all > 0 &&
         whole < (heaped ? whole_elements_tuning->least_whole_in_heaps : whole_elements_tuning->least_whole) * all;
}

bool ShownElements::lack_most() const {
  return missing > whole_elements_tuning->most_missing;
}

ShownElements shown_elements(const UvMap& uv, const Elements& elements, const Task& task) {
  return LaidElements(uv, elements, task).shown();
}

std::vector<uint8_t> torn_elements(const UvMap& uv, const Elements& elements, const Task& task) {
  LaidElements laid(uv, elements, task);
  const Size size = uv.size();
  std::vector<uint8_t> out;
  out.reserve(size_t(size.area()));
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) out.push_back(laid.is_torn(x, y) ? 1 : 0);
  return out;
}

}  // namespace terrazzo
