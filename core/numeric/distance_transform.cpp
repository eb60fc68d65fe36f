#include "core/numeric/distance_transform.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <tbb/parallel_for.h>

namespace terrazzo {

namespace {

/// Which threads work on the lines of a mask.
enum class Threads : uint8_t { all, own };

template <typename Visit>
void for_each_line(Threads threads, int count, const Visit& visit) {
  if (threads == Threads::all)
    tbb::parallel_for(0, count, visit);
  else
    for (int i = 0; i < count; i++) visit(i);
}

/// Distance to the nearest set pixel of the same column, at most `far`. Some columns at a time go down row by row: the
/// pixels of one column alone lie far apart in memory.
std::vector<int> column_distances(const std::vector<uint8_t>& mask, Size size, bool wraps, int far, Threads threads) {
  constexpr int at_once = 64;
  std::vector<int> g(mask.size());
  for_each_line(threads, (size.width + at_once - 1) / at_once, [&](int block) {
    const int first = block * at_once, columns = std::min(at_once, size.width - first);
    // A second lap carries distances across the border.
    const int laps = wraps ? 2 : 1;
    std::array<int, at_once> since;
    since.fill(far);
    for (int lap = 0; lap < laps; lap++)
      for (int y = 0; y < size.height; y++) {
        const size_t row = size_t(y) * size_t(size.width) + size_t(first);
        for (int x = 0; x < columns; x++) {
          since[x] = mask[row + x] ? 0 : std::min(far, since[x] + 1);
          g[row + x] = since[x];
        }
      }
    since.fill(far);
    for (int lap = 0; lap < laps; lap++)
      for (int y = size.height - 1; y >= 0; y--) {
        const size_t row = size_t(y) * size_t(size.width) + size_t(first);
        for (int x = 0; x < columns; x++) {
          since[x] = mask[row + x] ? 0 : std::min(far, since[x] + 1);
          g[row + x] = std::min(g[row + x], since[x]);
        }
      }
  });
  return g;
}

/// The lower envelope of the parabolas (x - i)^2 + g[i]^2 over one line: which parabola is lowest at each x.
std::vector<int> lowest_parabolas(const std::vector<int64_t>& g) {
  const int n = int(g.size());
  std::vector<int> site(n), from(n), out(n);
  const auto value = [&](int64_t x, int i) { return (x - i) * (x - i) + g[i] * g[i]; };
  // The first x from which the parabola of u lies below that of i (i < u).
  const auto meets = [&](int i, int u) {
    const int64_t numerator = int64_t{u} * u - int64_t{i} * i + g[u] * g[u] - g[i] * g[i];
    const int64_t denominator = 2 * (int64_t{u} - i);
    return numerator >= 0 ? numerator / denominator : -((-numerator + denominator - 1) / denominator);
  };
  int top = 0;
  site[0] = from[0] = 0;
  for (int u = 1; u < n; u++) {
    while (top >= 0 && value(from[top], site[top]) > value(from[top], u)) top--;
    if (top < 0) {
      top = 0;
      site[0] = u;
      from[0] = 0;
      continue;
    }
    const int64_t w = 1 + meets(site[top], u);
    if (w < n) {
      top++;
      site[top] = u;
      from[top] = int(std::max<int64_t>(0, w));
    }
  }
  for (int x = n - 1; x >= 0; x--) {
    out[x] = site[top];
    if (x == from[top] && top > 0) top--;
  }
  return out;
}

/// Visits every pixel with the nearest set pixel's column, which may lie beyond a border, and its distances along x
/// and y. `visit(x, y, column, dx, dy)`
template <typename Visit>
void for_each_nearest(const std::vector<uint8_t>& mask, Size size, bool wraps, Threads threads, const Visit& visit) {
  const std::vector<int> g = column_distances(mask, size, wraps, size.width + size.height, threads);
  for_each_line(threads, size.height, [&](int y) {
    // Where distances wrap, half a line more on either side holds every site that can be nearest.
    const int margin = wraps ? (size.width + 1) / 2 : 0;
    std::vector<int64_t> line(size_t(size.width) + 2 * margin);
    for (int i = 0; i < int(line.size()); i++) line[i] = g[size_t(y) * size.width + wrap(i - margin, size.width)];
    const std::vector<int> best = lowest_parabolas(line);
    for (int x = 0; x < size.width; x++) {
      const int i = best[x + margin];
      visit(x, y, i - margin, x + margin - i, line[i]);
    }
  });
}

std::vector<int64_t> squared_distances(const std::vector<uint8_t>& mask, Size size, bool wraps, Threads threads) {
  const int64_t far = size.width + size.height;
  std::vector<int64_t> out(mask.size());
  for_each_nearest(mask, size, wraps, threads, [&](int x, int y, int, int64_t dx, int64_t dy) {
    out[size_t(y) * size.width + x] = std::min(dx * dx + dy * dy, far * far);
  });
  return out;
}

std::vector<float> signed_distances(const std::vector<uint8_t>& mask, Size size, bool wraps, float limit,
                                    Threads threads) {
  std::vector<uint8_t> inverse(mask.size());
  for (size_t i = 0; i < mask.size(); i++) inverse[i] = !mask[i];
  const std::vector<int64_t> to_set = squared_distances(mask, size, wraps, threads);
  const std::vector<int64_t> to_unset = squared_distances(inverse, size, wraps, threads);
  std::vector<float> out(mask.size());
  for (size_t i = 0; i < mask.size(); i++) {
    const double d = mask[i] ? 0.5 - std::sqrt(double(to_unset[i])) : std::sqrt(double(to_set[i])) - 0.5;
    out[i] = std::clamp(float(d), -limit, limit);
  }
  return out;
}

}  // namespace

std::vector<int64_t> squared_distances(const std::vector<uint8_t>& mask, Size size, bool wraps) {
  return squared_distances(mask, size, wraps, Threads::all);
}

std::vector<uint32_t> nearest_set(const std::vector<uint8_t>& mask, Size size, bool wraps) {
  std::vector<uint32_t> out(mask.size());
  const auto at = [&](int x, int y) { return size_t(wrap(y, size.height)) * size.width + wrap(x, size.width); };
  for_each_nearest(mask, size, wraps, Threads::all, [&](int x, int y, int column, int64_t, int64_t dy) {
    const bool above = (wraps || y - dy >= 0) && mask[at(column, int(y - dy))];
    out[at(x, y)] = uint32_t(at(column, int(above ? y - dy : y + dy)));
  });
  return out;
}

std::vector<float> signed_distances(const std::vector<uint8_t>& mask, Size size, bool wraps, float limit) {
  return signed_distances(mask, size, wraps, limit, Threads::all);
}

std::vector<float> signed_distances_here(const std::vector<uint8_t>& mask, Size size, float limit) {
  return signed_distances(mask, size, false, limit, Threads::own);
}

}  // namespace terrazzo
