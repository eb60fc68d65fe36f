#pragma once

#include "core/analysis/repeats/exemplar_view.h"
#include "core/base/task.h"
#include "core/exemplar/features.h"
#include "core/exemplar/lattice.h"

namespace terrazzo {

struct FoundLattice {
  Lattice lattice;
  /// Joints seem to cross, but of what is between them the exemplar does not hold enough to tell.
  bool too_few = false;
};

/// Finds how an exemplar, or several of one surface that are seen at one scale, repeats from the autocorrelation of all
/// its weighted channels, or of their outlines where those repeat more surely: the cell whose repeats correlate most
/// and places between them least (Liu, Collins & Tsin 2004 judge lattices alike), or else the period of its courses or
/// columns, and their bond. Rank 0 if the certainty stays under `least_certainty`.
FoundLattice find_lattice(const std::vector<ExemplarView>& views, double least_certainty, const Task& task);
/// The same for all of an exemplar that its mask allows.
FoundLattice find_lattice(const Features& features, double least_certainty, const Task& task);

}  // namespace terrazzo
