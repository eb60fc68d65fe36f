#include "core/metrics/hybrids.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/disjoint_sets.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/tuning.h"
#include "core/image/float_planes.h"
#include "core/image/image_ops.h"
#include "core/numeric/distance_transform.h"
#include "core/numeric/watershed.h"

namespace terrazzo {

namespace {

struct HybridsTuning {
  double joint = 0.2;
  double whole = 0.85;
  int bent = 2;
  double crumb = 0.05;
};
const Tunable<HybridsTuning> hybrids_tuning(
    "hybrids", {{&HybridsTuning::joint, "joint", "inner radii",
                 "mean depth along a line up to which it is a joint. Higher: fewer elements are taken for two, lower: "
                 "two that touch are one more often",
                 "elements", 0, 1},
                {&HybridsTuning::whole, "whole", "of an element's area", "that must come from one for it to be whole",
                 "not measured: as the figure is defined", 0, 1},
                {&HybridsTuning::bent, "bent", "pixels", "by which the place in the exemplar may jump within a piece",
                 "not measured: as the figure is defined", 0, 64},
                {&HybridsTuning::crumb, "crumb", "of the median area", "below which a region belongs to its neighbour",
                 "elements", 0, 1}});

/// For each pixel of the exemplar: from 255 in the middle of a joint to 0 in the middle of an element.
std::vector<uint8_t> joints_of(const Elements& elements, bool wraps) {
  const std::vector<int64_t> squares =
      squared_distances(border_pixels(elements.at, elements.size, wraps), elements.size, wraps);
  const auto depth = [&](size_t i) { return std::sqrt(double(squares[i])); };
  std::vector<double> deepest(size_t(elements.count), 1);
  for (size_t i = 0; i < squares.size(); i++) deepest[elements.at[i]] = std::max(deepest[elements.at[i]], depth(i));
  std::vector<uint8_t> out(squares.size());
  for (size_t i = 0; i < out.size(); i++) out[i] = uint8_t(255 * (1 - depth(i) / deepest[elements.at[i]]));
  return out;
}

/// Connected regions of pixels that show one element from one copied piece.
class Pieces {
 public:
  Pieces(const UvMap& uv, const Elements& elements) : uv_(uv), elements_(elements), joined_(uv.pixels().size()) {
    const int w = uv.size().width, h = uv.size().height;
    for (int y = 0; y < h; y++)
      for (int x = 0; x < w; x++) {
        if (x + 1 < w || uv.wraps().x) join(x, y, (x + 1) % w, y, 1, 0);
        if (y + 1 < h || uv.wraps().y) join(x, y, x, (y + 1) % h, 0, 1);
      }
  }

  uint32_t of(size_t pixel) { return joined_.find(uint32_t(pixel)); }

 private:
  uint16_t element(const ExemplarPixel& p) const {
    return elements_.at[size_t(p.y) * size_t(elements_.size.width) + p.x];
  }
  bool is_near(int from, int to, int step, int length) const {
    int apart = std::abs(to - from - step);
    if (uv_.wraps().exemplar) apart = std::min(apart, std::abs(apart - length));
    return apart <= hybrids_tuning->bent;
  }
  void join(int x, int y, int u, int v, int right, int down) {
    const ExemplarPixel a = uv_.at(x, y), b = uv_.at(u, v);
    if (element(a) != element(b) || !is_near(a.x, b.x, right, uv_.exemplar().width) ||
        !is_near(a.y, b.y, down, uv_.exemplar().height))
      return;
    const auto width = size_t(uv_.size().width);
    joined_.join(uint32_t(size_t(y) * width + size_t(x)), uint32_t(size_t(v) * width + size_t(u)));
  }

  const UvMap& uv_;
  const Elements& elements_;
  DisjointSets joined_;
};

/// The result's own elements.
Regions result_elements(const UvMap& uv, const Elements& elements, const Task& task) {
  const std::vector<uint8_t> joints = joints_of(elements, uv.wraps().exemplar);
  std::vector<uint8_t> relief;
  relief.reserve(uv.pixels().size());
  for (const ExemplarPixel& p : uv.pixels()) relief.push_back(joints[size_t(p.y) * size_t(elements.size.width) + p.x]);
  task.check();
  const bool wraps = uv.wraps().x && uv.wraps().y;
  const Regions basins = catchment_basins(relief, uv.size(), wraps);
  task.check();
  const double least = 255 * (1 - hybrids_tuning->joint);
  std::vector<int64_t> areas(size_t(elements.count));
  for (const uint16_t e : elements.at) areas[e]++;
  std::ranges::nth_element(areas, areas.begin() + std::ptrdiff_t(areas.size() / 2));
  const auto smallest = int64_t(hybrids_tuning->crumb * double(areas[areas.size() / 2]));
  return joined(basins, region_borders(basins, relief, uv.size(), wraps), {least, least, 0, smallest});
}

}  // namespace

Elements labelled_elements(const ImagePtr& labels, Size size, const Task& task) {
  const Planes values = to_planes(*nearest_at_size(labels, size), whole(size), 1);
  task.check();
  std::vector<float> kinds = values.values;
  std::ranges::sort(kinds);
  kinds.erase(std::unique(kinds.begin(), kinds.end()), kinds.end());
  if (kinds.size() > size_t(most_elements))
    throw Error("labels", fmt::format("expected a picture with one value for each element, at most {}, found {} values",
                                      most_elements, kinds.size()));
  Elements out{size, {}, int(kinds.size()), 1};
  for (const float v : values.values) out.at.push_back(uint16_t(std::ranges::lower_bound(kinds, v) - kinds.begin()));
  return out;
}

HybridElements hybrid_elements(const UvMap& uv, const Elements& elements, const Task& task) {
  if (elements.size != uv.exemplar())
    throw Error("labels",
                fmt::format("expected labels of the exemplar that the uv map was made from, {}x{} pixels, "
                            "found {}x{}",
                            uv.exemplar().width, uv.exemplar().height, elements.size.width, elements.size.height));
  const Regions regions = result_elements(uv, elements, task);
  Pieces pieces(uv, elements);
  std::vector<std::pair<uint32_t, uint32_t>> parts;  // region and piece of each pixel
  std::vector<uint8_t> cut(size_t(regions.count), 0);
  const Size size = uv.size();
  for (size_t i = 0; i < regions.at.size(); i++) {
    parts.emplace_back(regions.at[i], pieces.of(i));
    const auto x = int(i % size_t(size.width)), y = int(i / size_t(size.width));
    if ((!uv.wraps().x && (x == 0 || x == size.width - 1)) || (!uv.wraps().y && (y == 0 || y == size.height - 1)))
      cut[regions.at[i]] = 1;
  }
  task.check();
  std::ranges::sort(parts);
  HybridElements out;
  int64_t all = 0, hybrid = 0, hybrids = 0;
  for (size_t i = 0; i < parts.size();) {
    const uint32_t region = parts[i].first;
    int64_t area = 0, largest = 0;
    while (i < parts.size() && parts[i].first == region) {
      const size_t begin = i;
      while (i < parts.size() && parts[i] == parts[begin]) i++;
      area += int64_t(i - begin);
      largest = std::max(largest, int64_t(i - begin));
    }
    if (cut[region]) continue;
    out.elements++;
    all += area;
    if (double(largest) >= hybrids_tuning->whole * double(area)) continue;
    hybrid += area;
    hybrids++;
  }
  out.by_area = double(hybrid) / double(std::max<int64_t>(1, all));
  out.by_number = double(hybrids) / std::max(1, out.elements);
  return out;
}

}  // namespace terrazzo
