#pragma once

#include <vector>

#include "core/analysis/regularity.h"
#include "core/repeats.h"

namespace terrazzo {

/// An exemplar that lies beside others in one, and how it repeats.
struct ExemplarPart {
  Rect place;
  ExemplarView view;
  Lattice lattice;
};

struct BroughtTogether {
  std::vector<LatticePart> parts;
  size_t kinds = 0;  ///< how many different ways to repeat are left
};

/// Brings parts that repeat alike together: cells of the same size and shape are shown as the same ones, moved by what
/// makes them most alike, so that joints of one part go on in another whatever their colours; parts that have only the
/// height of their courses in common, or the width of their columns, share these. What differs more keeps its own
/// lattice. Throws Cancelled.
BroughtTogether brought_together(const std::vector<ExemplarPart>& parts, const Task& task);

}  // namespace terrazzo
