#include "core/filter/curve.h"

#include <algorithm>

namespace terrazzo {

Curve::Curve(std::vector<std::pair<double, double>> points, bool smooth) : points_(std::move(points)) {
  const size_t count = points_.size();
  if (!smooth || count < 3) return;
  std::vector<double> steps(count - 1), rises(count - 1);  // width and slope of each piece
  for (size_t i = 0; i + 1 < count; i++) {
    steps[i] = points_[i + 1].first - points_[i].first;
    rises[i] = (points_[i + 1].second - points_[i].second) / steps[i];
  }
  slopes_.resize(count, 0.0);
  slopes_.front() = rises.front();
  slopes_.back() = rises.back();
  for (size_t i = 1; i + 1 < count; i++) {
    if (rises[i - 1] * rises[i] <= 0) continue;  // a peak, a valley or level ground
    const double before = 2 * steps[i] + steps[i - 1], after = steps[i] + 2 * steps[i - 1];
    slopes_[i] = (before + after) / (before / rises[i - 1] + after / rises[i]);
  }
}

double Curve::at(double x) const {
  if (!(x > points_.front().first)) return points_.front().second;  // NaN as well
  if (x >= points_.back().first) return points_.back().second;
  const auto above = std::upper_bound(points_.begin(), points_.end(), x,
                                      [](double value, const auto& point) { return value < point.first; });
  const size_t i = size_t(above - points_.begin()) - 1;
  const auto [x0, y0] = points_[i];
  const auto [x1, y1] = points_[i + 1];
  const double width = x1 - x0, t = (x - x0) / width;
  if (slopes_.empty()) return y0 + (y1 - y0) * t;
  const double t2 = t * t, t3 = t2 * t;
  return y0 * (2 * t3 - 3 * t2 + 1) + y1 * (3 * t2 - 2 * t3) +
         width * (slopes_[i] * (t3 - 2 * t2 + t) + slopes_[i + 1] * (t3 - t2));
}

}  // namespace terrazzo
