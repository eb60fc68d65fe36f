#include "nodes/common/synthesis/wrapping_size.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/portable_math.h"
#include "core/base/tuning.h"

namespace terrazzo {

namespace {

struct WrappingSizeTuning {
  double bending_weight = 2;
};
const Tunable<WrappingSizeTuning> wrapping_size_tuning(
    "wrapping_size",
    {
        {&WrappingSizeTuning::bending_weight, "bending_weight", "logarithms of a factor on the side",
         "to a cell that is bent by its length. Higher: sizes that wrap are farther from those asked for; lower: their "
         "cells are bent",
         "not measured: a side half as long again is as bad as cells bent by a fifth"},
    });

/// The length of a side, near `length`, that wraps best.
int best_side(const Lattice& lattice, int length, bool along_x, int slack) {
  int best = length;
  double least = std::numeric_limits<double>::max();
  for (int n = length / 2 + 1; n <= length + length / 8; n++) {
    const int room = slack + std::max(0, n - length);
    const double bent = lattice.bent({n, n}, along_x, !along_x, {room, room});
    if (bent > Lattice::most_bent() && n != length) continue;
    const double badness = std::abs(portable::log(double(n) / length)) + wrapping_size_tuning->bending_weight * bent;
    if (badness >= least) continue;
    least = badness;
    best = n;
  }
  return best;
}

}  // namespace

Size best_wrapping_size(const Lattice& lattice, Size size, bool wraps_x, bool wraps_y, Size slack) {
  if (lattice.rank == 0) return size;
  return {wraps_x ? best_side(lattice, size.width, true, slack.width) : size.width,
          wraps_y ? best_side(lattice, size.height, false, slack.height) : size.height};
}

}  // namespace terrazzo
