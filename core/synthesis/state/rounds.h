#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "core/synthesis/state/plane_window.h"

namespace terrazzo {

/// Schedules jobs on parts of a field, whose order matters, in rounds: the jobs of a round lie so far apart that they
/// can run at the same time, and every earlier job near by is in an earlier round.
class Rounds {
 public:
  /// The pixels of two jobs of one round lie more than three times `reach` apart.
  Rounds(const Plane& field, int reach)
      : width_(field.size.width),
        side_(reach + 1),
        cells_{{(width_ + side_ - 1) / side_, (field.size.height + side_ - 1) / side_}, field.tile_x, field.tile_y},
        last_(size_t(cells_.size.area()), 0) {}

  void add(int job, std::span<const int> pixels) {
    int round = 0;
    for_each_near(pixels, [&](size_t cell) { round = std::max(round, last_[cell]); });
    for_each_near(pixels, [&](size_t cell) { last_[cell] = round + 1; });
    if (round == int(rounds_.size())) rounds_.emplace_back();
    rounds_[size_t(round)].push_back(job);
  }
  const std::vector<std::vector<int>>& all() const { return rounds_; }

 private:
  /// Calls `visit` for the cells of the pixels and two more on each side. As every job marks so many, four cells lie
  /// between the jobs of a round, or three and a narrow one where the field wraps around.
  template <typename Visit>
  void for_each_near(std::span<const int> pixels, const Visit& visit) const {
    int previous = -1;
    for (const int i : pixels) {
      const int cx = i % width_ / side_, cy = i / width_ / side_, cell = cy * cells_.size.width + cx;
      if (cell == previous) continue;
      previous = cell;
      for (int dy = -2; dy <= 2; dy++)
        for (int dx = -2; dx <= 2; dx++)
          if (const int64_t n = cells_.index(cx + dx, cy + dy); n >= 0) visit(size_t(n));
    }
  }

  int width_;
  int side_;
  Plane cells_;
  std::vector<int> last_;  // of each cell: the first round without a job near it
  std::vector<std::vector<int>> rounds_;
};

}  // namespace terrazzo
