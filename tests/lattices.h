#pragma once

#include <cmath>

#include "core/exemplar/lattice.h"

namespace terrazzo::test {

/// Whether a lattice repeats after (x, y), to a tenth of a cell.
inline bool repeats_by(const Lattice& l, double x, double y) {
  const double d = l.first.x() * l.second.y() - l.first.y() * l.second.x();
  const double i = (x * l.second.y() - y * l.second.x()) / d, j = (y * l.first.x() - x * l.first.y()) / d;
  return std::abs(i - std::round(i)) < 0.1 && std::abs(j - std::round(j)) < 0.1;
}

}  // namespace terrazzo::test
