#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/analysis/space/planes.h"
#include "core/base/task.h"
#include "core/exemplar/lattice.h"

namespace terrazzo {

/// In pixels; shorter repeats are grain.
double shortest_repeat();

/// Offset of a maximum between three samples, in steps, -0.5..0.5: the vertex of their parabola.
inline double vertex_near(double before, double at, double after) {
  const double bend = before - 2 * at + after;
  return bend < 0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
}

/// Autocorrelation by lag in pixels, over all channels; symmetric about the origin. Immutable; thread-safe.
class Correlation {
 public:
  /// `lags`: 0..width-1 in x, -(height-1)..height-1 in y, row by row. `wraps`: the exemplar tiles.
  Correlation(std::vector<double> values, Size lags, Size exemplar, bool wraps);

  Size lags() const { return lags_; }
  Size exemplar() const { return exemplar_; }
  bool wraps() const { return wraps_; }
  /// Whether enough of the exemplar overlaps itself at this lag. If it tiles, lags are limited to half its sides.
  bool covers(double dx, double dy) const {
    const double x = std::abs(dx), y = std::abs(dy);
    if (wraps_) return x <= exemplar_.width * 0.5 && y <= exemplar_.height * 0.5;
    return x <= lags_.width - 3 && y <= lags_.height - 3 &&
           (exemplar_.width - x) * (exemplar_.height - y) >= least_overlap_;
  }
  double at(int dx, int dy) const {
    if (dx < 0) {
      dx = -dx;
      dy = -dy;
    }
    return values_[size_t(dy + lags_.height - 1) * lags_.width + dx];
  }
  double at(const Vector2d& d) const { return at(int(std::floor(d.x() + 0.5)), int(std::floor(d.y() + 0.5))); }

  /// The highest correlation within one pixel of a lag, and its lag, with subpixel accuracy.
  std::pair<Vector2d, double> peak_near(const Vector2d& d) const {
    const int cx = int(std::floor(d.x() + 0.5)), cy = int(std::floor(d.y() + 0.5));
    int bx = cx, by = cy;
    for (int y = cy - 1; y <= cy + 1; y++)
      for (int x = cx - 1; x <= cx + 1; x++)
        if (at(x, y) > at(bx, by)) {
          bx = x;
          by = y;
        }
    // The vertex of a parabola along each axis.
    double value = at(bx, by);
    const auto vertex = [&](double left, double middle, double right) {
      const double offset = vertex_near(left, middle, right);
      value += 0.25 * (right - left) * offset;
      return offset;
    };
    const double x = bx + vertex(at(bx - 1, by), at(bx, by), at(bx + 1, by));
    const double y = by + vertex(at(bx, by - 1), at(bx, by), at(bx, by + 1));
    return {{x, y}, value};
  }

 private:
  std::vector<double> values_;
  Size lags_, exemplar_;
  bool wraps_;
  double least_overlap_;  ///< in pixels
};

/// Autocorrelation of an exemplar's details, channels weighted by their variance, for lags up to five sixths of its
/// sides, or all of them, cyclically, if it tiles. `counts`: weight per pixel, 0..1; empty: 1. Throws Cancelled.
Correlation correlate(const Planes& planes, const std::vector<float>& counts, const Task& task);

/// Correlation of several exemplars of one surface at one scale: the mean, weighted by overlap at each lag. At least
/// one; if several, none may tile.
Correlation pooled(const std::vector<Correlation>& all);

/// Edge strength over all channels, as one channel: shows joints even if bricks differ in colour. Throws
/// Cancelled.
Planes outlines(const Planes& planes, const Task& task);

/// The same by orientation, as two channels: edge strength times the cosine and the sine of twice the edge's angle
/// (Granlund's double-angle representation). Parts that mirror each other, or are turned, differ in it. Throws
/// Cancelled.
Planes orientations(const Planes& planes, const Task& task);

}  // namespace terrazzo
