#include "core/analysis/elements/partition.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/portable_math.h"
#include "core/base/tuning.h"
#include "core/exemplar/elements.h"
#include "core/numeric/distance_transform.h"

namespace terrazzo {

namespace {

struct PartitionTuning {
  double smallest = 4;
  double of_large = 0.45;
  double large = 0.35;
  double crumb = 0.1;
  double weak = 0.35;
  double thin = 2.5;
  double compact_enough = 0.5;
  int fewest = 4;
  double largest = 0.4;
};
const Tunable<PartitionTuning> partition_tuning(
    "partition",
    {
        {&PartitionTuning::smallest, "smallest", "widths of a line",
         "side of the smallest element. Higher: chips and pebbles belong to their neighbours; lower: crumbs in joints "
         "are elements",
         "elements", 1, 64},
        {&PartitionTuning::of_large, "of_large", "of the step from lines given up to lines kept",
         "how high a line must be between two that are large. Higher: stones that touch are one; lower: large stones "
         "are cut along veins",
         "elements", 0, 1},
        {&PartitionTuning::large, "large", "of the median area", "from which on an element is large. See of_large",
         "elements", 0.01, 100},
        {&PartitionTuning::crumb, "crumb", "of the median area",
         "below which a region is a crumb in a joint. See smallest", "elements", 0, 1},
        {&PartitionTuning::weak, "weak", "of the step from lines given up to lines kept",
         "below which a line's pixel is weak. Higher: fewer exemplars have elements; lower: rock and soil have some",
         "elements", 0, 1},
        {&PartitionTuning::thin, "thin", "widths of a line",
         "to the border at most, in a region that is a joint rather than an element. Higher: narrow slates are none; "
         "lower: wide joints are elements",
         "elements", 0.5, 32},
        {&PartitionTuning::compact_enough, "compact_enough", "1 for a square",
         "from which on shapes count no more. Higher: long boards are less sure; lower: networks pass for elements",
         "elements", 0.01, 1},
        {&PartitionTuning::fewest, "fewest", "elements", "in an exemplar that has any",
         "not measured: fewer are no two by two tiles", 1},
        {&PartitionTuning::largest, "largest", "of the exemplar", "that the largest element may take up",
         "not measured: what is left has too few others", 0, 1},
    });

/// The height that best divides borders into high and low ones (Otsu 1979), each counting by its length.
double dividing_height(const std::vector<RegionBorder>& borders) {
  std::array<double, 256> lengths{};
  double total = 0, sum = 0;
  for (const RegionBorder& b : borders) {
    const auto height = size_t(b.mean());
    lengths[height] += double(b.length);
    total += double(b.length);
    sum += double(b.length) * double(height);
  }
  double best = -1, divide = 128, below = 0, below_sum = 0;
  for (size_t height = 0; height + 1 < lengths.size(); height++) {
    below += lengths[height];
    below_sum += lengths[height] * double(height);
    if (below <= 0 || below >= total) continue;
    const double step = (sum - below_sum) / (total - below) - below_sum / below;
    const double variance = below * (total - below) * step * step;
    if (variance <= best) continue;
    best = variance;
    divide = double(height) + 1;
  }
  return divide;
}

struct Heights {
  double length = 0, sum = 0, squares = 0;
  void add(const RegionBorder& b) {
    length += double(b.length);
    sum += double(b.height);
    squares += b.mean() * b.mean() * double(b.length);
  }
  double mean() const { return sum / std::max(1.0, length); }
  double variance() const { return std::max(0.0, squares / std::max(1.0, length) - mean() * mean()); }
};

/// Heights of borders within regions, and between them.
struct Lines {
  Heights given_up, kept;
  double at(double step) const { return given_up.mean() + step * (kept.mean() - given_up.mean()); }
};
Lines lines_of(const Regions& basins, const std::vector<RegionBorder>& borders, const Regions& regions,
               const std::vector<uint8_t>& relief, Size size, bool wraps) {
  std::vector<uint32_t> region_of(size_t(basins.count));
  for (size_t i = 0; i < basins.at.size(); i++) region_of[basins.at[i]] = regions.at[i];
  Lines lines;
  for (const RegionBorder& b : borders)
    if (region_of[b.a] == region_of[b.b]) lines.given_up.add(b);
  for (const RegionBorder& b : region_borders(regions, relief, size, wraps)) lines.kept.add(b);
  return lines;
}

int64_t median_area(const Regions& regions) {
  std::vector<int64_t> areas(size_t(regions.count));
  for (const uint32_t r : regions.at) areas[r]++;
  const auto middle = areas.begin() + std::ptrdiff_t(areas.size() / 2);
  std::nth_element(areas.begin(), middle, areas.end());
  return *middle;
}

/// Whether the relief around a pixel, as far as a line is wide, stays below a height.
bool all_below(const std::vector<uint8_t>& relief, Size size, bool wraps, int x, int y, int reach, double height) {
  for (int j = y - reach; j <= y + reach; j++)
    for (int i = x - reach; i <= x + reach; i++) {
      const int u = wraps ? wrap(i, size.width) : std::clamp(i, 0, size.width - 1);
      const int v = wraps ? wrap(j, size.height) : std::clamp(j, 0, size.height - 1);
      if (relief[size_t(v) * size_t(size.width) + size_t(u)] >= height) return false;
    }
  return true;
}

double weak_share(const std::vector<uint8_t>& relief, const std::vector<uint8_t>& border, Size size, bool wraps,
                  double line, double height) {
  const int reach = std::max(1, int(line + 0.5));
  int64_t weak = 0, all = 0;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      if (!border[size_t(y) * size_t(size.width) + size_t(x)]) continue;
      all++;
      weak += all_below(relief, size, wraps, x, y, reach, height);
    }
  return double(weak) / double(std::max<int64_t>(1, all));
}

/// The share of the pixels beyond a line's width from any border where the relief is nearer to the mean of the lines
/// kept than to the mean of these pixels.
double stray_share(const std::vector<uint8_t>& relief, const std::vector<int64_t>& distance, double line,
                   double lines_kept) {
  std::array<int64_t, 256> pixels{};
  int64_t all = 0, sum = 0;
  const double within = 2 * line;
  for (size_t i = 0; i < relief.size(); i++) {
    if (double(distance[i]) <= within * within) continue;
    pixels[relief[i]]++;
    all++;
    sum += relief[i];
  }
  if (all == 0) return 1;
  const double middle = (double(sum) / double(all) + lines_kept) / 2;
  int64_t stray = 0;
  for (size_t height = 0; height < pixels.size(); height++)
    if (double(height) >= middle) stray += pixels[height];
  return double(stray) / double(all);
}

/// What shapes say: compact, thin, largest, number.
void judge_shapes(Partition& p, const std::vector<uint8_t>& border, const std::vector<int64_t>& distance, double line) {
  struct Shape {
    double area = 0, outline = 0;
    int64_t deepest = 0;
  };
  std::vector<Shape> shapes(size_t(p.regions.count));
  for (size_t i = 0; i < border.size(); i++) {
    Shape& s = shapes[p.regions.at[i]];
    s.area++;
    s.outline += border[i];
    s.deepest = std::max(s.deepest, distance[i]);
  }
  const double deep = partition_tuning->thin * line, all = double(border.size());
  double squares = 0;
  for (const Shape& s : shapes) {
    p.compact += s.area / all * std::min(1.0, 16 * s.area / std::max(1.0, s.outline * s.outline));
    p.largest = std::max(p.largest, s.area / all);
    squares += s.area / all * (s.area / all);
    if (double(s.deepest) < deep * deep) p.thin += s.area / all;
  }
  p.number = 1 / squares;
}

/// The share of the picture in regions that have pixels in every column, or in every row.
double spanning_share(const Regions& regions, Size size) {
  struct Reach {
    int64_t area = 0;
    int columns = 0, rows = 0, last_column = -1, last_row = -1;
  };
  std::vector<Reach> reach(size_t(regions.count));
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      Reach& r = reach[regions.at[size_t(y) * size_t(size.width) + size_t(x)]];
      r.area++;
      r.rows += r.last_row != y;
      r.last_row = y;
    }
  for (int x = 0; x < size.width; x++)
    for (int y = 0; y < size.height; y++) {
      Reach& r = reach[regions.at[size_t(y) * size_t(size.width) + size_t(x)]];
      r.columns += r.last_column != x;
      r.last_column = x;
    }
  int64_t spanning = 0;
  for (const Reach& r : reach)
    if (r.columns >= size.width || r.rows >= size.height) spanning += r.area;
  return double(spanning) / double(size.area());
}

}  // namespace

double Partition::quality() const {
  if (regions.count < partition_tuning->fewest || regions.count > most_elements) return 0;
  const double shapes = std::max(0.0, 1 - 2 * thin) * std::min(1.0, compact / partition_tuning->compact_enough);
  return contrast * shapes * (1 - spanning) * std::max(0.0, 1 - 3 * weak) *
         (largest > partition_tuning->largest ? 0.3 : 1);
}

double Partition::confidence() const {
  return quality() * std::max(0.0, 1 - 2 * stray) * portable::root<3>(portable::log(std::max(1.0, number)));
}

Partition partitioned(const std::vector<uint8_t>& relief, Size size, bool wraps, double line) {
  const Regions basins = catchment_basins(relief, size, wraps);
  const std::vector<RegionBorder> borders = region_borders(basins, relief, size, wraps);
  const double divide = dividing_height(borders);
  JoiningRule rule{divide, divide, 0, int64_t(partition_tuning->smallest * line * partition_tuning->smallest * line)};
  Partition p{.regions = joined(basins, borders, rule)};
  const Lines first = lines_of(basins, borders, p.regions, relief, size, wraps);
  rule.least_of_large = std::min(divide, first.at(partition_tuning->of_large));
  const auto median = double(median_area(p.regions));
  rule.large = int64_t(partition_tuning->large * median);
  rule.smallest = std::max(rule.smallest, int64_t(partition_tuning->crumb * median));
  p.regions = joined(basins, borders, rule);
  const Lines lines = lines_of(basins, borders, p.regions, relief, size, wraps);
  p.contrast = (lines.kept.mean() - lines.given_up.mean()) /
               std::sqrt((lines.kept.variance() + lines.given_up.variance()) / 2 + 1);
  const std::vector<uint8_t> border = border_pixels(p.regions.at, size, wraps);
  p.weak = weak_share(relief, border, size, wraps, line, lines.at(partition_tuning->weak));
  const std::vector<int64_t> distance = squared_distances(border, size, wraps);
  p.stray = stray_share(relief, distance, line, lines.kept.mean());
  judge_shapes(p, border, distance, line);
  p.spanning = spanning_share(p.regions, size);
  return p;
}

}  // namespace terrazzo
