#include "core/analysis/regularity.h"

#include <algorithm>
#include <vector>

#include "core/analysis/bands.h"
#include "core/analysis/bonds.h"
#include "core/analysis/cell_search.h"
#include "core/analysis/lag_correlation.h"
#include "core/analysis/planes.h"
#include "core/analysis/straight_lines.h"
#include "core/analysis/usable.h"
#include "core/bounds.h"

namespace terrazzo {

namespace {

constexpr int most_side = 256;     // periods are found to a fraction of a pixel; more resolution brings nothing
constexpr int smallest_side = 16;  // less has no room for repeats
// Pixels. Coarse levels see nothing of finer cells and would mix what they show; they keep pieces of two by two apart.
constexpr double smallest_cell = 7.5;
constexpr double least_distinct = 0.15;  // from here on cells say more than the bands they lie in

Lattice two_by_two(const Lattice& l, const Features& features) {
  Lattice out = l;
  for (Vector2 Lattice::*v : {&Lattice::first, &Lattice::second}) {
    Lattice twice = out;
    twice.*v = {2 * (out.*v).x, 2 * (out.*v).y};
    // Of an odd number of cells no two by two fit into an exemplar that tiles.
    if (twice.fits(features.size(), features.wraps(), features.wraps())) out = twice;
  }
  return out;
}

struct Found {
  Lattice lattice;
  double alike = 0;  ///< how much repeats are alike
};

/// What repeats may be the colours or, where those vary from brick to brick, only the joints. Cells before bands.
Found searched(const Correlation& values, const Correlation& joints, double least_certainty) {
  Bands bands;
  Cell cell;
  for (const Correlation* r : {&values, &joints}) {
    const Bands courses = bands_of(*r, true), columns = bands_of(*r, false);
    std::vector<Lattice> grids;
    if (courses.lattice.rank > 0 && columns.lattice.rank > 0)
      grids.push_back({2, columns.lattice.first, courses.lattice.first, 0});
    for (const Bands& b : {courses, columns})
      if (b.lattice.certainty >= least_certainty && b.distinct > bands.distinct) bands = b;
    const Cell c = best_cell(*r, grids);
    if (c.distinct > cell.distinct)
      cell = {without_false_repeats(r == &values ? joints : values, c.lattice), c.distinct};
  }
  if (cell.distinct >= least_distinct && cell.lattice.certainty >= least_certainty)
    return {cell.lattice, cell.lattice.certainty};
  if (bands.lattice.rank > 0) return {bands.lattice, bands.alike};
  return {{0, {}, {}, std::min(cell.distinct, cell.lattice.certainty)}, 0};
}

/// What a mask leaves to be seen of an exemplar.
struct View {
  ExemplarPlanes planes;
  ExemplarPlanes counts;  ///< one channel: 1 where pixels are allowed; without values if all are
  double scale = 1;       ///< pixels of the finest level to one of these

  bool empty() const { return std::min(planes.size.width, planes.size.height) < smallest_side; }
};

View view_of(const Features& features, const Task& task) {
  View view{weighted_planes(features, task), {}};
  const std::vector<uint8_t> allowed = allowed_pixels(features);
  if (!allowed.empty()) {
    const Rect seen = bounds(features.size(), [&](size_t i) { return allowed[i] != 0; });
    view.planes = cropped(view.planes, seen);
    view.counts = cropped({features.size(), 1, features.wraps(), {allowed.begin(), allowed.end()}}, seen);
  }
  while (!view.empty() && std::max(view.planes.size.width, view.planes.size.height) > most_side) {
    view.planes = halved(view.planes);
    if (!allowed.empty()) view.counts = halved(view.counts);
    view.scale *= 2;
  }
  return view;
}

}  // namespace

FoundLattice find_lattice(const Features& features, double least_certainty, const Task& task) {
  if (std::min(features.size().width, features.size().height) < smallest_side) return {};
  const View view = view_of(features, task);
  if (view.empty()) return {};  // of a narrow strip nothing is left to see
  const ExemplarPlanes& planes = view.planes;
  const ExemplarPlanes edges = outlines(planes);
  const Found found = searched(correlate(planes, view.counts.values, task), correlate(edges, view.counts.values, task),
                               least_certainty);
  Lattice best = found.lattice;
  if (best.certainty < least_certainty || !best.is_valid()) best = {0, {}, {}, best.certainty};
  const Lattice lines = planes.wraps ? lattice_of_lines(edges, best) : Lattice{};
  if (lines.rank > 0 && lines.certainty >= least_certainty)
    best = lines;
  else if (best.rank > 0)
    best.certainty = std::max(best.certainty, found.alike);
  if (best.rank == 1)
    if (const Lattice bond = bond_of(planes, best, task); bond.certainty >= least_certainty) best = bond;
  const bool too_few = best.rank < 2 && !planes.wraps && lines_cross(edges);
  if (best.rank == 0) return {best, too_few};
  for (Vector2* v : {&best.first, &best.second}) *v = {v->x * view.scale, v->y * view.scale};
  best = best.fitted(features.size(), features.wraps(), features.wraps());
  if (best.rank == 2 && best.cell_area() < smallest_cell * smallest_cell) best = two_by_two(best, features);
  return {best, too_few};
}

}  // namespace terrazzo
