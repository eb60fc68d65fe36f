#pragma once

#include <array>
#include <cmath>

namespace terrazzo {

/// Coordinates along and across courses, which may rise; in pixels of one level.
struct CourseAxes {
  bool upright = false;  ///< courses run along y
  double rise = 0;       ///< pixels across per pixel along

  int shift(int along) const { return int(std::floor(rise * along + 0.5)); }
  /// x and y.
  std::array<int, 2> at(int along, int across) const {
    across += shift(along);
    return upright ? std::array{across, along} : std::array{along, across};
  }
  int along(int x, int y) const { return upright ? y : x; }
  double across(double x, double y) const { return upright ? x - rise * y : y - rise * x; }
};

}  // namespace terrazzo
