#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/analysis/space/planes.h"
#include "core/base/task.h"
#include "core/exemplar/lattice.h"

namespace terrazzo {

/// Pixels; what repeats after fewer is grain.
double shortest_repeat();

/// Of a maximum between its neighbours, in steps: the vertex of a parabola.
inline double vertex_near(double before, double at, double after) {
  const double bend = before - 2 * at + after;
  return bend < 0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
}

/// Correlation over lags, all channels together; symmetric about the origin.
class Correlation {
 public:
  /// `lags`: 0..width-1 in x, -(height-1)..height-1 in y, row by row. `wraps`: of an exemplar that tiles.
  Correlation(std::vector<double> values, Size lags, Size exemplar, bool wraps);

  Size lags() const { return lags_; }
  Size exemplar() const { return exemplar_; }
  bool wraps() const { return wraps_; }
  /// Whether enough of the exemplar lies on itself at this lag. All lags of an exemplar that tiles are within half its
  /// sides.
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

  /// The highest lag within one pixel and the correlation there, to a fraction of a pixel.
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

/// The correlation of an exemplar's details with themselves, channels weighted by their variance: over lags up to five
/// sixths of its sides or, around its borders, all of its sides if it tiles. `counts`: per pixel how much it counts,
/// 0..1; empty: all do. Throws Cancelled.
Correlation correlate(const Planes& planes, const std::vector<float>& counts, const Task& task);

/// What several exemplars of one surface, at one scale, say together: the mean, by how much of them lies on itself at a
/// lag. At least one; none of several may tile.
Correlation pooled(const std::vector<Correlation>& all);

/// Edge strength, all channels together, as one channel: joints show in it however much bricks differ in colour.
Planes outlines(const Planes& planes);

}  // namespace terrazzo
