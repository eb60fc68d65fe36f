#pragma once

#include "core/analysis/repeats/exemplar_view.h"
#include "core/base/task.h"
#include "core/exemplar/features.h"
#include "core/exemplar/lattice.h"

namespace terrazzo {

/// From which on a lattice counts, if nothing else is said.
inline constexpr double least_lattice_certainty = 0.08;

struct FoundLattice {
  Lattice lattice;
  /// Joints cross, but the exemplar holds too few cells to find the lattice.
  bool too_few = false;
  bool has_lines = false;  ///< level or upright ones stand out, or bands
  Lattice by_lines{};      ///< of an exemplar without cells: that of long lines, or rank 0
  int courses = 0;         ///< of an exemplar that is a single cell: those that element_courses() finds in it
};

/// Finds the lattice of an exemplar, or of several of one surface at one scale, from the autocorrelation of all
/// weighted channels, or of their outlines if those repeat more clearly: the cell with the highest contrast between
/// lattice points and the places between (as Liu, Collins & Tsin 2004), else the period of courses or columns, and
/// their bond. Rank 0 below `least_certainty` (0..1). Throws Cancelled.
FoundLattice find_lattice(const std::vector<ExemplarView>& views, double least_certainty, const Task& task);
/// The same for the allowed area of an exemplar, by what few elements, one of a few cells, and long lines tell as well.
FoundLattice find_lattice(const Features& features, double least_certainty, const Task& task);

/// Of an exemplar that tiles and shows too few tiles or bricks for their correlation to tell: what their joints follow,
/// and in what courses they lie. What was found otherwise if that has more cells, if there are none that are sure, or
/// if a mask hides some. Throws Cancelled.
FoundLattice told_by_few_elements(const Features& features, const FoundLattice& found, const Task& task);

/// A quick look at half the size, or less of large exemplars: false if nothing in the exemplar repeats nearly well
/// enough for a lattice of that certainty. Throws Cancelled.
bool may_have_lattice(const Features& features, double least_certainty, const Task& task);

}  // namespace terrazzo
