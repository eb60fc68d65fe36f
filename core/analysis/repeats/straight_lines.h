#pragma once

#include "core/analysis/repeats/exemplar_view.h"
#include "core/analysis/repeats/lag_correlation.h"
#include "core/base/task.h"
#include "core/exemplar/lattice.h"

namespace terrazzo {

/// The lattice of a tileable exemplar with straight lines from border to border, such as the joints of a single tile:
/// one cell, or several if lines repeat. `outlines`: see outlines(); `joints`: their correlation. Rank 1 if lines run
/// along one axis only; rank 0 if there are none, or they agree with `found`, a lattice found otherwise.
Lattice lattice_of_lines(const Planes& outlines, const Correlation& joints, const Lattice& found);

/// Courses as high as the exemplar, or columns as wide, where nearly all that differs does so across them: a stripe on
/// a wall, which would be cut to pieces. Narrower ones if they repeat. Rank 0 if there are none, or they agree with
/// `found`. Throws Cancelled.
Lattice lattice_of_single_bands(const ExemplarView& view, const Planes& outlines, const Lattice& found,
                                const Task& task);

/// What of all variance lies between lines, at least, if there are any.
double least_of_lines();
/// Whether what differs between rows (or columns) has edges there: clouds and shades of a ground have none.
bool has_edges_between(const Planes& outlines, bool rows);
/// Whether straight lines run from border to border in both directions, as joints between tiles, or posts around
/// boards.
bool lines_cross(const Planes& outlines);
/// The lattice of an exemplar in which straight lines of half its side and more run in both directions, wherever they
/// end, so that what lies between them is in no courses: one cell, or several if it tiles and lines repeat. Rank 0 if
/// there are no such lines. `bands`: the step, in pixels, of courses or columns of which there are several, or 0: lines
/// must go on across three of them, since boards' joints need not. Throws Cancelled.
Lattice lattice_of_crossing_lines(const Planes& planes, const Planes& outlines, double bands, const Task& task);
/// Whether lines run from border to border in one direction at least, as joints between courses.
bool has_lines(const Planes& outlines);

}  // namespace terrazzo
