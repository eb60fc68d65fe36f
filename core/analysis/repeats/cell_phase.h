#pragma once

#include "core/analysis/repeats/exemplar_view.h"
#include "core/exemplar/lattice.h"

namespace terrazzo {

/// An exemplar and by what its pixels are taken together.
struct RepeatingView {
  const ExemplarView& view;
  Lattice lattice;
};

/// By how many cells, along each step, the cells of `other` must be moved to be most like those of `first`: the
/// position that is c cells on in `first` looks like that which is c plus this many cells on in `other`. Both are
/// averaged over all their cells, and colours and outlines both count; corresponding steps have the same order.
Vector2d phase_between(const RepeatingView& first, const RepeatingView& other);

}  // namespace terrazzo
