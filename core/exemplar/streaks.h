#pragma once

#include <algorithm>

#include "core/base/geometry.h"

namespace terrazzo {

inline constexpr int longest_streak_step = 16;

/// How much an exemplar of streaks (brushed metal, wood grain, pipes) can be shortened along them and still show them:
/// analysis and synthesis see the mean of so many pixels as one, and with that much more of each streak.
struct Streaks {
  int x = 1;  ///< pixels along x that count as one, 1..longest_streak_step; 1: no streaks along x
  int y = 1;  ///< the same along y; not both are above 1

  bool any() const { return x > 1 || y > 1; }
  bool is_valid() const { return std::min(x, y) == 1 && std::max(x, y) <= longest_streak_step; }
  /// What is left of an exemplar of that size: whole steps only.
  Size shortened(Size exemplar) const { return {exemplar.width / x, exemplar.height / y}; }
  /// The least size that covers a surface: the last step may hang over.
  Size covering(Size surface) const { return {(surface.width + x - 1) / x, (surface.height + y - 1) / y}; }
  bool operator==(const Streaks&) const = default;
};

}  // namespace terrazzo
