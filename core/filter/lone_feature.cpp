#include "core/filter/lone_feature.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>

namespace terrazzo {

namespace {

// Large enough for a texture to average out, small enough for a lamp or a knot to fill some (experiments.md,
// "lone_feature").
constexpr int along_side = 40;
constexpr int most_samples = 512;  // along the longer side: twelve along a cell
constexpr int reach = 2;           // of a place's surroundings, in cells
constexpr int apart = 6;           // what is not farther off counts as the same thing
constexpr int per_cell = 2 * LoneFeatureSearch::channels;

/// Sums over surroundings, around the borders.
void sum_surroundings(const std::vector<int64_t>& values, Size cells, std::vector<int64_t>& across,
                      std::vector<int64_t>& out) {
  for (int y = 0; y < cells.height; y++)
    for (int x = 0; x < cells.width; x++) {
      int64_t sum = 0;
      for (int d = -reach; d <= reach; d++) sum += values[size_t(y * cells.width + wrap(x + d, cells.width))];
      across[size_t(y * cells.width + x)] = sum;
    }
  for (int y = 0; y < cells.height; y++)
    for (int x = 0; x < cells.width; x++) {
      int64_t sum = 0;
      for (int d = -reach; d <= reach; d++) sum += across[size_t(wrap(y + d, cells.height) * cells.width + x)];
      out[size_t(y * cells.width + x)] = sum;
    }
}

}  // namespace

LoneFeatureSearch::LoneFeatureSearch(Size exemplar)
    : exemplar_(exemplar), step_(std::max(1, std::max(exemplar.width, exemplar.height) / most_samples)) {
  const int longer = std::max(exemplar.width, exemplar.height);
  const Size cells{int(int64_t{exemplar.width} * along_side / std::max(1, longer)),
                   int(int64_t{exemplar.height} * along_side / std::max(1, longer))};
  if (longer < 2 * along_side || std::min(cells.width, cells.height) < 3 * apart) return;
  cells_ = cells;
  sums_.resize(size_t(cells.area()));
}

void LoneFeatureSearch::add(int x, int y, const double* colour) {
  if (x % step_ != 0 || y % step_ != 0) return;
  const int longer = std::max(exemplar_.width, exemplar_.height);
  const int column = int(int64_t{x} * along_side / longer), row = int(int64_t{y} * along_side / longer);
  if (column >= cells_.width || row >= cells_.height) return;
  Cell& cell = sums_[size_t(row * cells_.width + column)];
  cell.count++;
  for (int c = 0; c < channels; c++) {
    cell.sum[c] += colour[c];
    cell.squares[c] += colour[c] * colour[c];
  }
}

std::vector<int32_t> LoneFeatureSearch::features() const {
  std::vector<int32_t> out;
  constexpr double steps = 1023;
  for (const Cell& cell : sums_)
    for (int c = 0; c < channels; c++) {
      const auto count = double(std::max<int64_t>(1, cell.count));
      const double mean = cell.sum[c] / count, variance = cell.squares[c] / count - mean * mean;
      out.push_back(int32_t(mean * steps + 0.5));
      out.push_back(int32_t(std::sqrt(std::max(0.0, variance)) * steps + 0.5));
    }
  return out;
}

LoneFeature LoneFeatureSearch::find() const {
  LoneFeature out;
  if (sums_.empty()) return out;
  const std::vector<int32_t> all = features();
  std::vector<int64_t> difference(sums_.size()), across(sums_.size()), around(sums_.size());
  std::vector<int64_t> nearest(sums_.size(), std::numeric_limits<int64_t>::max());
  double total = 0;
  for (int dy = 0; dy < cells_.height; dy++)
    for (int dx = 0; dx < cells_.width; dx++) {
      for (int y = 0; y < cells_.height; y++)
        for (int x = 0; x < cells_.width; x++) {
          const int32_t* a = &all[size_t(y * cells_.width + x) * per_cell];
          const int32_t* b =
              &all[size_t(wrap(y + dy, cells_.height) * cells_.width + wrap(x + dx, cells_.width)) * per_cell];
          int64_t sum = 0;
          for (int i = 0; i < per_cell; i++) sum += int64_t{a[i] - b[i]} * (a[i] - b[i]);
          difference[size_t(y * cells_.width + x)] = sum;
        }
      sum_surroundings(difference, cells_, across, around);
      for (const int64_t v : around) total += double(v);
      if (std::max(std::min(dx, cells_.width - dx), std::min(dy, cells_.height - dy)) <= apart) continue;
      for (size_t i = 0; i < nearest.size(); i++) nearest[i] = std::min(nearest[i], around[i]);
    }
  const double mean = total / (double(sums_.size()) * double(sums_.size()));
  if (mean <= 0) return out;
  const int longer = std::max(exemplar_.width, exemplar_.height);
  for (int y = reach; y < cells_.height - reach; y++)
    for (int x = reach; x < cells_.width - reach; x++) {
      const double strength = double(nearest[size_t(y * cells_.width + x)]) / mean;
      if (strength > out.strength)
        out = {strength, 0, (2 * x + 1) * longer / (2 * along_side), (2 * y + 1) * longer / (2 * along_side)};
    }
  const auto middle = nearest.begin() + ptrdiff_t(nearest.size() / 2);
  std::nth_element(nearest.begin(), middle, nearest.end());
  out.usual = double(*middle) / mean;
  return out;
}

LoneFeature lone_feature(const Image& image) {
  LoneFeatureSearch search(image.size());
  const int step = search.step(), channels = image.channels(), used = std::min(channels, LoneFeatureSearch::channels);
  for_each_strip(image, [&](const Rect& r, const float* v) {
    for (int y = (r.y + step - 1) / step * step; y < r.bottom(); y += step)
      for (int x = 0; x < r.width; x += step) {
        const float* pixel = v + (size_t(y - r.y) * size_t(r.width) + size_t(x)) * size_t(channels);
        double colour[LoneFeatureSearch::channels] = {};
        for (int c = 0; c < used; c++) colour[c] = std::max(0.0, std::min(1.0, double(pixel[c])));  // 1: no number
        search.add(x, y, colour);
      }
  });
  return search.find();
}

}  // namespace terrazzo
