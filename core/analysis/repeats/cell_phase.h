#pragma once

#include "core/analysis/repeats/exemplar_view.h"
#include "core/exemplar/lattice.h"

namespace terrazzo {

/// An exemplar with its lattice.
struct RepeatingView {
  const ExemplarView& view;
  Lattice lattice;
};

/// Phase of `other` against `first`, in cells along each step: position c in `first` looks like position c plus the
/// phase in `other`. Compares cells averaged over each exemplar, by colours and outlines. Corresponding steps must have
/// the same order.
Vector2d phase_between(const RepeatingView& first, const RepeatingView& other, const Task& task);

}  // namespace terrazzo
