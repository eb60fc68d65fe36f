#include "core/material/shared_detail.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/hash.h"
#include "core/filter/resample.h"

namespace terrazzo {

namespace {

constexpr int compared_side = 256;

/// Values at a grid of points.
struct Grid {
  Size size;
  std::vector<double> values;

  double at(int x, int y) const {
    return values[size_t((y + size.height) % size.height) * size_t(size.width) + size_t((x + size.width) % size.width)];
  }
  template <typename Value>
  Grid with(Value value) const {
    Grid out{size, {}};
    out.values.reserve(values.size());
    for (int y = 0; y < size.height; y++)
      for (int x = 0; x < size.width; x++) out.values.push_back(value(x, y));
    return out;
  }
};

/// The mean of the channels without alpha.
Grid grey(const ImagePtr& image, Size size) {
  const ImagePtr small = resampled(image, size, "box", Outside::wrap, Hasher().add("shared detail").digest());
  const std::vector<float> pixels = small->pixels();
  const size_t channels = size_t(small->channels()), counted = channels == 2 || channels == 4 ? channels - 1 : channels;
  Grid out{size, std::vector<double>(size_t(size.area()))};
  for (size_t i = 0; i < out.values.size(); i++)
    for (size_t c = 0; c < counted; c++) out.values[i] += pixels[i * channels + c];
  return out;
}

Grid blurred(const Grid& grid) {
  constexpr int reach = 4;
  const auto along = [&](const Grid& g, int dx, int dy) {
    return g.with([&](int x, int y) {
      double sum = 0;
      for (int k = -reach; k <= reach; k++) sum += g.at(x + k * dx, y + k * dy);
      return sum / (2 * reach + 1);
    });
  };
  return along(along(grid, 1, 0), 0, 1);
}

Grid high_pass(const Grid& grid) {
  const Grid coarse = blurred(grid);
  return grid.with([&](int x, int y) { return grid.at(x, y) - coarse.at(x, y); });
}

Grid slopes(const Grid& grid) {
  return blurred(grid.with([&](int x, int y) {
    return std::abs(grid.at(x + 1, y) - grid.at(x - 1, y)) + std::abs(grid.at(x, y + 1) - grid.at(x, y - 1));
  }));
}

double mean(const Grid& g) {
  double sum = 0;
  for (const double v : g.values) sum += v;
  return sum / double(g.values.size());
}

/// The correlation of two grids; 1 if one of them is flat.
double correlation(const Grid& a, const Grid& b) {
  const double mean_a = mean(a), mean_b = mean(b);
  double ab = 0, aa = 0, bb = 0;
  for (size_t i = 0; i < a.values.size(); i++) {
    const double da = a.values[i] - mean_a, db = b.values[i] - mean_b;
    ab += da * db;
    aa += da * da;
    bb += db * db;
  }
  constexpr double flat = 1e-9;  // less than 8 bits can store
  const double count = double(a.values.size());
  return aa < flat * count || bb < flat * count ? 1 : std::abs(ab) / std::sqrt(aa * bb);
}

}  // namespace

double shared_detail(const ImagePtr& a, const ImagePtr& b) {
  const Size size{std::min({compared_side, a->width(), b->width()}),
                  std::min({compared_side, a->height(), b->height()})};
  const Grid grey_a = grey(a, size), grey_b = grey(b, size);
  return std::max(correlation(high_pass(grey_a), high_pass(grey_b)), correlation(slopes(grey_a), slopes(grey_b)));
}

}  // namespace terrazzo
