#pragma once

#include <array>
#include <cmath>

namespace terrazzo {

/// Positions of a surface as its courses have them: along them, and across them from where they begin.
struct CourseAxes {
  bool upright = false;  ///< courses run along y
  double rise = 0;       ///< what they rise by across, for each pixel along

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
