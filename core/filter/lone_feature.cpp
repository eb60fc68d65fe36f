#include "core/filter/lone_feature.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <utility>

namespace terrazzo {

namespace {

// Large enough for a texture to average out, small enough for a lamp or a knot to fill some (experiments.md,
// "lone_feature").
constexpr int along_side = 40;
constexpr int most_samples = 512;  // along the longer side: twelve along a cell
constexpr int reach = 2;           // of a place's surroundings, in cells
constexpr int apart = 6;           // what is not farther off counts as the same thing
constexpr int per_cell = 2 * LoneFeatureSearch::channels;

/// How much each cell differs from the one at some distance from it, summed over surroundings, all around the borders.
/// Whole numbers: of at most 1.6e8.
class Differences {
 public:
  Differences(const std::vector<int32_t>& features, Size cells)
      : cells_(cells), twice_(size_t(per_cell)), single_(area()), across_(area()), around_(area()) {
    // Everything twice each way, one number after the other: no index has to wrap.
    const int w = cells.width, h = cells.height;
    for (int i = 0; i < per_cell; i++)
      for (int y = 0; y < 2 * h; y++)
        for (int x = 0; x < 2 * w; x++)
          twice_[size_t(i)].push_back(features[size_t(((y % h) * w + x % w) * per_cell + i)]);
  }

  const std::vector<int32_t>& at(int dx, int dy) {
    const int w = cells_.width, h = cells_.height;
    std::ranges::fill(single_, 0);
    for (const std::vector<int32_t>& values : twice_)
      for (int y = 0; y < h; y++) {
        const int32_t *a = &values[size_t(y * 2 * w)], *b = &values[size_t((y + dy) * 2 * w + dx)];
        int32_t* out = &single_[size_t(y * w)];
        for (int x = 0; x < w; x++) out[x] += (a[x] - b[x]) * (a[x] - b[x]);
      }
    std::vector<int32_t> row(size_t(w + 2 * reach));
    for (int y = 0; y < h; y++) {
      for (int x = 0; x < w + 2 * reach; x++) row[size_t(x)] = single_[size_t(y * w + wrap(x - reach, w))];
      sum_of(&across_[size_t(y * w)], w, [&](int d) { return &row[size_t(reach + d)]; });
    }
    for (int y = 0; y < h; y++)
      sum_of(&around_[size_t(y * w)], w, [&](int d) { return &across_[size_t(wrap(y + d, h) * w)]; });
    return around_;
  }

 private:
  size_t area() const { return size_t(cells_.area()); }

  template <class F>
  static void sum_of(int32_t* out, int length, const F& line) {
    std::fill_n(out, length, 0);
    for (int d = -reach; d <= reach; d++) {
      const int32_t* v = line(d);
      for (int i = 0; i < length; i++) out[i] += v[i];
    }
  }

  Size cells_;
  std::vector<std::vector<int32_t>> twice_;
  std::vector<int32_t> single_, across_, around_;
};

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
  Differences differences(features(), cells_);
  std::vector<int64_t> nearest(sums_.size(), std::numeric_limits<int64_t>::max());
  double total = 0;
  for (int dy = 0; dy < cells_.height; dy++)
    for (int dx = 0; dx < cells_.width; dx++) {
      // The way back is as long.
      const int back_x = wrap(-dx, cells_.width), back_y = wrap(-dy, cells_.height);
      if (std::pair(back_y, back_x) < std::pair(dy, dx)) continue;
      const bool is_both = back_x == dx && back_y == dy;
      const std::vector<int32_t>& around = differences.at(dx, dy);
      for (const int32_t v : around) total += (is_both ? 1.0 : 2.0) * v;
      if (std::max(std::min(dx, back_x), std::min(dy, back_y)) <= apart) continue;
      for (int y = 0; y < cells_.height; y++)
        for (int x = 0; x < cells_.width; x++) {
          const int64_t v = around[size_t(y * cells_.width + x)];
          for (const int at :
               {y * cells_.width + x, wrap(y + dy, cells_.height) * cells_.width + wrap(x + dx, cells_.width)})
            nearest[size_t(at)] = std::min(nearest[size_t(at)], v);
        }
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
