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
  double least_whole = 0.5;
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

}  // namespace

bool ShownElements::are_broken() const {
  return all > 0 && whole < whole_elements_tuning->least_whole * all;
}

bool ShownElements::lack_most() const {
  return missing > whole_elements_tuning->most_missing;
}

ShownElements shown_elements(const UvMap& uv, const Elements& elements, const Task& task) {
  const bool wraps = uv.wraps().exemplar;
  const std::vector<uint8_t> inside = insides(elements, wraps);
  const auto at = [&](const ExemplarPixel& p) { return size_t(p.y) * size_t(elements.size.width) + p.x; };
  const Sample sample(uv, std::max(1, int(typical_side(elements) / whole_elements_tuning->samples)));
  task.check();

  // Insides that meet are one element, and of those what goes on from one exemplar pixel to the next one piece.
  const int w = sample.size.width, h = sample.size.height;
  DisjointSets result(sample.shown.size()), pieces(sample.shown.size());
  const auto goes_on = [&](int from, int to, int step, int length) {
    int apart = std::abs(to - from - step);
    if (wraps) apart = std::min(apart, length - apart);
    return apart < sample.step;
  };
  const auto meet = [&](int x, int y, int u, int v, int right, int down) {
    const auto i = uint32_t(y * w + x), j = uint32_t(v * w + u);
    const ExemplarPixel a = sample.shown[i], b = sample.shown[j];
    if (!inside[at(a)] || !inside[at(b)]) return;
    result.join(i, j);
    if (elements.at[at(a)] == elements.at[at(b)] && goes_on(a.x, b.x, right * sample.step, elements.size.width) &&
        goes_on(a.y, b.y, down * sample.step, elements.size.height))
      pieces.join(i, j);
  };
  for (int y = 0; y < h; y++)
    for (int x = 0; x < w; x++) {
      if (x + 1 < w || uv.wraps().x) meet(x, y, (x + 1) % w, y, 1, 0);
      if (y + 1 < h || uv.wraps().y) meet(x, y, x, (y + 1) % h, 0, 1);
    }
  task.check();

  std::vector<double> areas(size_t(elements.count), 0.0);  // of the insides, in samples
  double total = 0;
  for (size_t i = 0; i < inside.size(); i++)
    if (inside[i]) {
      areas[elements.at[i]] += 1.0 / (sample.step * sample.step);
      total += 1.0 / (sample.step * sample.step);
    }
  std::vector<uint8_t> seen(size_t(elements.count), 0);
  for (const ExemplarPixel& p : sample.shown)
    if (inside[at(p)]) seen[elements.at[at(p)]] = 1;
  std::vector<std::pair<uint32_t, uint32_t>> parts;  // element of the result and piece
  std::vector<uint8_t> cut(sample.shown.size(), 0);
  for (size_t i = 0; i < sample.shown.size(); i++) {
    if (!inside[at(sample.shown[i])]) continue;
    parts.emplace_back(result.find(uint32_t(i)), pieces.find(uint32_t(i)));
    const int x = int(i) % w, y = int(i) / w;
    if ((!uv.wraps().x && (x == 0 || x == w - 1)) || (!uv.wraps().y && (y == 0 || y == h - 1)))
      cut[parts.back().first] = 1;
  }
  std::ranges::sort(parts);
  ShownElements out;
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
    const uint16_t shows = elements.at[at(sample.shown[piece])];
    const bool whole =
        largest >= whole_elements_tuning->alone * area && largest >= whole_elements_tuning->most_of_it * areas[shows];
    if (cut[element] && whole) continue;
    area_of_all += area;
    if (!whole) continue;
    out.whole++;
    distinct.insert(shows);
  }
  out.distinct = int(distinct.size());
  for (size_t e = 0; e < seen.size(); e++)
    if (!seen[e]) out.missing += areas[e] / total;
  // Torn elements are counted by their area: they are more, or, melted together, fewer than they should be.
  if (total > 0) out.all = std::max(out.whole, int(area_of_all * elements.count / total + 0.5));
  return out;
}

}  // namespace terrazzo
