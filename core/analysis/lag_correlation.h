#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/analysis/planes.h"
#include "core/lattice.h"
#include "core/task.h"

namespace terrazzo {

/// Correlation over lags, all channels together; symmetric about the origin.
class Correlation {
 public:
  Correlation(std::vector<double> values, Size lags) : values_(std::move(values)), lags_(lags) {}

  Size lags() const { return lags_; }
  bool covers(double dx, double dy) const {
    return std::abs(dx) <= lags_.width - 3 && std::abs(dy) <= lags_.height - 3;
  }
  double at(int dx, int dy) const {
    if (dx < 0) {
      dx = -dx;
      dy = -dy;
    }
    return values_[size_t(dy + lags_.height - 1) * lags_.width + dx];
  }
  double at(Vector2 d) const { return at(int(std::floor(d.x + 0.5)), int(std::floor(d.y + 0.5))); }

  /// The highest lag within one pixel, to a fraction of a pixel.
  std::pair<Vector2, double> peak_near(Vector2 d) const {
    const int cx = int(std::floor(d.x + 0.5)), cy = int(std::floor(d.y + 0.5));
    int bx = cx, by = cy;
    for (int y = cy - 1; y <= cy + 1; y++)
      for (int x = cx - 1; x <= cx + 1; x++)
        if (at(x, y) > at(bx, by)) {
          bx = x;
          by = y;
        }
    const auto vertex = [](double left, double middle, double right) {
      const double bend = left - 2 * middle + right;
      return bend < 0 ? std::clamp(0.5 * (left - right) / bend, -0.5, 0.5) : 0.0;
    };
    return {{bx + vertex(at(bx - 1, by), at(bx, by), at(bx + 1, by)),
             by + vertex(at(bx, by - 1), at(bx, by), at(bx, by + 1))},
            at(bx, by)};
  }

 private:
  std::vector<double> values_;
  Size lags_;
};

/// The correlation of an exemplar's details with themselves, channels weighted by their variance, over lags up to six
/// tenths of its sides. Throws Cancelled.
Correlation correlate(const ExemplarPlanes& planes, const Task& task);

/// Edge strength, all channels together, as one channel: joints show in it however much bricks differ in colour.
ExemplarPlanes outlines(const ExemplarPlanes& planes);

}  // namespace terrazzo
