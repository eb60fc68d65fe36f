#include "core/synthesis/state/comparison_window.h"

#include <algorithm>

namespace terrazzo {

namespace {

constexpr int full_radius = 2;  // 24 pixels: as many as PixelCorrector has room for

Window sorted_window(int radius) {
  Window w;
  for (int j = -radius; j <= radius; j++)
    for (int i = -radius; i <= radius; i++)
      if (i || j) w.push_back({i, j});
  std::stable_sort(w.begin(), w.end(),
                   [](const auto& a, const auto& b) { return a[0] * a[0] + a[1] * a[1] < b[0] * b[0] + b[1] * b[1]; });
  return w;
}

}  // namespace

const Window& full_window() {
  static const Window window = sorted_window(full_radius);
  return window;
}

const Window& sparse_window() {
  static const Window window = {{-1, -1}, {1, -1}, {-1, 1}, {1, 1}, {0, -2}, {0, 2}, {-2, 0}, {2, 0}};
  return window;
}

}  // namespace terrazzo
