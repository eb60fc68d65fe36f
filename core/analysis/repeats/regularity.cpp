#include "core/analysis/repeats/regularity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/analysis/elements/find_elements.h"
#include "core/analysis/repeats/bands.h"
#include "core/analysis/repeats/bonds.h"
#include "core/analysis/repeats/cell_search.h"
#include "core/analysis/repeats/lag_correlation.h"
#include "core/analysis/repeats/straight_lines.h"
#include "core/analysis/repeats/through_lines.h"
#include "core/analysis/space/mask_pyramid.h"
#include "core/base/tuning.h"
#include "core/exemplar/element_courses.h"
#include "core/exemplar/element_lattice.h"

namespace terrazzo {

namespace {

struct RegularityTuning {
  double smallest_cell = 7.5;
  double least_distinct = 0.15;
  double told_twice = 2;
  double few_cells = 6.5;
  double least_alike_of_few = 0.6;
  double smallest_ground = 128;
  double least_sure_stripes = 0.6;
  double least_turned = 0.6;
  double quick_share = 0.7;
};
const Tunable<RegularityTuning> regularity_tuning(
    "regularity",
    {
        {&RegularityTuning::smallest_cell, "smallest_cell", "pixels",
         "finer cells are put together two by two. Higher: coarse levels keep more pieces "
         "apart; lower: they see nothing of such cells and mix them",
         "What each rule decides"},
        {&RegularityTuning::least_distinct, "least_distinct", "distinctness",
         "from which on cells say more than the bands they lie in. Higher: courses without a "
         "bond; lower: bonds by chance",
         "What each rule decides"},
        {&RegularityTuning::told_twice, "told_twice", "factor",
         "on the distinctness of cells that colours and joints tell, each by themselves. Higher: chance is taken for "
         "cells; lower: worn tiles are torn",
         "regularity", 1, 10},
        {&RegularityTuning::few_cells, "few_cells", "cells of the exemplar",
         "up to which they must be alike by more. Higher: fewer parts that were repeated to "
         "make it tile count as cells; lower: large cells are found",
         "regularity"},
        {&RegularityTuning::least_alike_of_few, "least_alike_of_few", "correlation",
         "of so few cells. Higher: plates, tiles and bricks of few cells have no lattice; "
         "lower: grass and ground, of which 260 textures reach 0.58, are laid out in squares",
         "regularity"},
        {&RegularityTuning::smallest_ground, "smallest_ground", "pixels a side",
         "of a part that repeats and in which nothing does. Higher: copies of ground are repeated; lower: motifs "
         "without lines are torn",
         "regularity"},
        {&RegularityTuning::least_sure_stripes, "least_sure_stripes", "certainty",
         "of stripes aslant. Higher: fewer are found; lower: those that are only a part of "
         "what is shown, as of a door, are taken for all",
         "What each rule decides"},
        {&RegularityTuning::least_turned, "least_turned", "share of the correlation",
         "of orientations that turned cells lack. Higher: they are taken for one another; "
         "lower: threads of a weave are told apart by chance",
         "regularity", 0, 1},
        {&RegularityTuning::quick_share, "quick_share", "of the certainty asked for",
         "that something must correlate by at half the size. Higher: less is searched for "
         "a lattice; lower: no lattice is missed",
         "wrap_detection", 0, 1},
    });

// Of the quick look at half the size. Smaller exemplars take no time; the longest side is twice what the search looks
// at.
constexpr int quick_side = 128, most_quick_side = 512;
constexpr int quick_lag = 4;  // pixels from which on repeats count: of fine cells several lie that far apart

Lattice two_by_two(const Lattice& l, Size exemplar, bool wraps) {
  Lattice out = l;
  for (Vector2d Lattice::*v : {&Lattice::first, &Lattice::second}) {
    Lattice twice = out;
    twice.*v *= 2;
    // Of an odd number of cells no two by two fit into an exemplar that tiles.
    if (twice.fits(exemplar, wraps, wraps)) out = twice;
  }
  return out;
}

/// Whether two lattices have the same points near the origin, to a part of a cell.
bool are_alike(const Lattice& a, const Lattice& b) {
  if (a.rank != 2 || b.rank != 2 || std::abs(a.cell_area() - b.cell_area()) > 0.1 * a.cell_area()) return false;
  return std::ranges::all_of(std::array{b.first, b.second}, [&](const Vector2d& step) {
    const Vector2d cells = a.cells(step);
    return (cells.array() - (cells.array() + 0.5).floor()).abs().maxCoeff() < 0.1;
  });
}

/// `told_twice`: by the colours and by the joints, each by itself.
bool is_sure(const Cell& cell, bool told_twice, Size exemplar, double least_certainty) {
  const bool few = cell.lattice.cell_area() * regularity_tuning->few_cells > double(exemplar.area());
  return cell.distinct * (told_twice ? regularity_tuning->told_twice : 1) >= regularity_tuning->least_distinct &&
         cell.lattice.certainty >=
             (few ? std::max(least_certainty, regularity_tuning->least_alike_of_few) : least_certainty);
}

struct Repetition {
  Lattice lattice;
  double alike = 0;  ///< how much repeats are alike
};

// What lies half a period of stripes apart is nearly -1, tiles of four colours at random -1/3 (experiments.md,
// "regularity").
constexpr double most_inverted = -0.5;

/// Whether what lies a step of the lattice apart is light where the other is dark: joints on both sides of stripes are
/// alike.
bool is_inverted(const Correlation& values, const Lattice& l) {
  return std::ranges::any_of(std::array{l.first, l.second}, [&](const Vector2d& step) {
    return values.covers(step.x(), step.y()) && values.at(step) < most_inverted;
  });
}

/// What repeats may be the colours or, where those vary from brick to brick, only the joints. Cells before bands, and
/// level ones before those aslant.
Repetition searched(const Correlation& values, const Correlation& joints, double least_certainty) {
  Bands bands;
  Cell cell;
  Lattice of_values;
  bool told_twice = false;
  for (const Correlation* r : {&values, &joints}) {
    const Bands courses = bands_of(*r, true), columns = bands_of(*r, false);
    std::vector<Lattice> grids;
    if (courses.lattice.rank > 0 && columns.lattice.rank > 0)
      grids.push_back({2, columns.lattice.first, courses.lattice.first, 0});
    for (const Bands& b : {courses, columns})
      if (b.lattice.certainty >= least_certainty && b.distinct > bands.distinct) bands = b;
    const Cell c = best_cell(*r, grids);
    if (r == &values)
      of_values = c.lattice;
    else
      told_twice = are_alike(of_values, c.lattice);
    if (c.distinct <= cell.distinct) continue;
    const Lattice l = without_false_repeats(r == &values ? joints : values, c.lattice);
    if (!is_inverted(values, l)) cell = {l, c.distinct};
  }
  if (is_sure(cell, told_twice, values.exemplar(), least_certainty)) return {cell.lattice, cell.lattice.certainty};
  if (bands.lattice.rank > 0) return {bands.lattice, bands.alike};
  const auto are_sure = [](const Bands& b) { return b.lattice.certainty >= regularity_tuning->least_sure_stripes; };
  // The joints on both sides of a stripe are alike: of one that comes once they tell half.
  const Bands once = single_stripes_of(values, joints);
  for (const Bands& b : {stripes_of(values), are_sure(once) ? once : stripes_of(joints)})
    if (are_sure(b) && b.distinct > bands.distinct && !is_inverted(values, b.lattice)) bands = b;
  if (bands.lattice.rank > 0) return {bands.lattice, bands.alike};
  return {{0, {}, {}, std::min(cell.distinct, cell.lattice.certainty)}, 0};
}

/// The highest correlation of all lags of so many pixels and more, up to half the exemplar's sides: parts of it that
/// were shown twice to make it tile lie farther apart.
double highest_from(const Correlation& r, int least_lag) {
  double highest = 0;
  for (int dy = -r.exemplar().height / 2; dy <= r.exemplar().height / 2; dy++)
    for (int dx = 0; dx <= r.exemplar().width / 2; dx++)
      if (dx * dx + dy * dy >= least_lag * least_lag) highest = std::max(highest, r.at(dx, dy));
  return highest;
}

/// The lattice of straight lines from border to border: across them an exemplar without bands is one course, or one
/// column; where they cross, or go across bands, there are cells, unless the exemplar does not tile. `found` if there
/// are none.
Lattice with_through_lines(const Planes& planes, const Lattice& found, double least_certainty) {
  // Cells of what does not tile would come with its borders.
  if (!planes.wraps && found.rank > 0) return found;
  const double rows = strongest_line(planes, true), columns = strongest_line(planes, false);
  if (!planes.wraps && std::min(rows, columns) >= 1) return found;
  const auto step = [](double lines, double found_step, int all) {
    return found_step > 0 || lines < 1 ? found_step : all;
  };
  const Vector2d right{step(columns, found.first.x(), planes.size.width), 0};
  const Vector2d down{0, step(rows, found.first.y(), planes.size.height)};
  const double certainty = std::max(found.certainty, 1 - 0.5 / std::max(rows, columns));
  const int rank = int(right.x() > 0) + int(down.y() > 0);
  if (rank <= found.rank || certainty < least_certainty) return found;
  return rank == 2 ? Lattice{2, right, down, certainty} : Lattice{1, right + down, {}, certainty};
}

/// The lattice, or a multiple of it if its cells are turned or mirrored: the columns of a chevron floor.
Lattice told_by_orientation(const Lattice& lattice, const std::vector<const ExemplarView*>& views, const Task& task) {
  std::vector<Correlation> all;
  for (const ExemplarView* v : views) all.push_back(correlate(orientations(v->planes, task), v->counts.values, task));
  const Correlation turned = pooled(all);
  return lattice.rank == 1 ? with_turned_bands(turned, lattice)
                           : without_false_repeats(turned, lattice, regularity_tuning->least_turned);
}

}  // namespace

FoundLattice find_lattice(const std::vector<ExemplarView>& all, double least_certainty, const Task& task) {
  std::vector<const ExemplarView*> views;
  for (const ExemplarView& v : all)
    if (!v.empty()) views.push_back(&v);
  if (views.empty()) return {};
  std::vector<Planes> edges;
  std::vector<Correlation> values, joints;
  for (const ExemplarView* v : views) {
    edges.push_back(outlines(v->planes, task));
    values.push_back(correlate(v->planes, v->counts.values, task));
    joints.push_back(correlate(edges.back(), v->counts.values, task));
  }
  const Correlation of_values = pooled(values), of_joints = pooled(joints);
  const Repetition found = searched(of_values, of_joints, least_certainty);
  Lattice best = found.lattice;
  if (best.rank > 0) best = told_by_orientation(best, views, task);
  if (best.certainty < least_certainty || !best.is_valid()) best = {0, {}, {}, best.certainty};
  const ExemplarView& largest =
      **std::ranges::max_element(views, {}, [](const ExemplarView* v) { return v->seen.area(); });
  const bool wraps = views.size() == 1 && largest.planes.wraps;
  // Of an exemplar that does not tile, a few bands without edges are the shades of a ground.
  const auto has_edges = [&](const Planes& outlines) { return has_edges_between(outlines, best.first.x() == 0); };
  if (!wraps && best.rank == 1 && !come_often(best, of_values.exemplar()) && std::ranges::none_of(edges, has_edges))
    best = {0, {}, {}, best.certainty};
  const Lattice lines = wraps ? lattice_of_lines(edges.front(), of_joints, best) : Lattice{};
  if (lines.rank > 0 && lines.certainty >= least_certainty)
    best = lines;
  else if (best.rank > 0)
    best.certainty = std::max(best.certainty, found.alike);
  if (best.rank < 2 && views.size() == 1)
    if (const Lattice bands = lattice_of_single_bands(largest, edges.front(), best, task); bands.rank > 0) best = bands;
  if (best.rank == 1)
    if (const Lattice bond = bond_of(largest.planes, best, task); bond.certainty >= least_certainty) best = bond;
  FoundLattice out;
  out.too_few = best.rank < 2 && !wraps && std::ranges::any_of(edges, lines_cross);
  const Size size{largest.seen.width, largest.seen.height};
  const auto in_exemplar = [&](Lattice l) {
    for (Vector2d* v : {&l.first, &l.second}) *v *= largest.scale;
    return l.fitted(size, wraps, wraps);
  };
  // Of two courses, or columns, the joints across one are about half the exemplar long.
  const long bands = best.rank == 1 ? std::lround(count_bands(best, largest.planes.size)) : 0;
  if (best.rank < 2 && (wraps ? bands != 2 : out.too_few))
    if (const Lattice l =
            lattice_of_crossing_lines(largest.planes, edges.front(), !wraps && bands > 1 ? best.first.sum() : 0, task);
        l.rank > 0)
      out.by_lines = in_exemplar(l);
  if (best.rank < 2 && views.size() == 1 && out.by_lines.rank == 0)
    if (const Lattice l = with_through_lines(largest.planes, best, least_certainty); l.rank > best.rank)
      out.by_lines = in_exemplar(l);
  out.has_lines = best.rank > 0 || std::ranges::any_of(edges, has_lines);
  out.lattice = best;
  if (best.rank == 0) return out;
  best = in_exemplar(best);
  if (best.rank == 2 && best.cell_area() < regularity_tuning->smallest_cell * regularity_tuning->smallest_cell)
    best = two_by_two(best, size, wraps);
  out.lattice = best;
  return out;
}

bool may_have_lattice(const Features& features, double least_certainty, const Task& task) {
  if (std::min(features.size().width, features.size().height) < quick_side || !allowed_pixels(features).empty())
    return true;
  Planes seen = halved(*weighted_planes(features, task));
  while (std::max(seen.size.width, seen.size.height) > most_quick_side) seen = halved(seen);
  for (const Planes& planes : {seen, outlines(seen, task)})
    if (highest_from(correlate(planes, {}, task), quick_lag) >= regularity_tuning->quick_share * least_certainty)
      return true;
  return false;
}

namespace {

ElementsPtr surely_found_elements(const Features& features, const Task& task) {
  const ElementsPtr elements = find_elements(features, task);
  return elements && elements->certainty >= sure_elements ? elements : nullptr;
}

/// Of a few cells, which may be copies that made the exemplar larger, or its motif: what repeats in one of them, or
/// nothing if nothing does and no line stands out. Else `found`.
FoundLattice told_by_one_cell(const Planes& planes, const FoundLattice& found, double least_certainty,
                              const Task& task) {
  const Lattice& l = found.lattice;
  const Size size{int(std::lround(l.first.x())), int(std::lround(l.second.y()))};
  const double cells = l.rank == 2 ? double(planes.size.area()) / l.cell_area() : 0;
  if (cells < 2 || cells > regularity_tuning->few_cells || size.width < 1 || size.height < 1) return found;
  // Of an exemplar that does not tile the lattice is off by a part of a pixel, which finer ones would add up.
  const Vector2d right(size.width, 0), down(0, size.height);
  if (std::max((l.first - right).norm(), (l.second - down).norm()) > (planes.wraps ? 0 : 1)) return found;
  Planes cell = cropped(planes, whole(size));
  cell.wraps = true;
  const FoundLattice inside = find_lattice({view_of(cell, {}, whole(size))}, least_certainty, task);
  const Lattice& i = inside.lattice;
  const bool is_ground = i.rank == 0 && i.certainty < least_certainty && !inside.has_lines &&
                         std::min(size.width, size.height) >= regularity_tuning->smallest_ground;
  const bool are_courses = i.rank == 1 && !i.comes_once(size) && i.certainty >= regularity_tuning->least_alike_of_few;
  const bool repeats = planes.wraps && (are_courses || (i.rank == 2 && !i.is_single_cell(size)));
  return is_ground || repeats ? inside : found;
}

int count_courses(const Elements& elements, const Features& features) {
  return int(element_courses(elements, features.wraps()).bands.size());
}

}  // namespace

FoundLattice told_by_few_elements(const Features& features, const FoundLattice& found, const Task& task) {
  const Lattice& l = found.lattice;
  const Size size = features.size();
  const double cells = l.rank == 2 ? double(size.area()) / l.cell_area() : l.rank == 1 ? count_bands(l, size) : 0;
  if (features.mask() || cells > most_few_elements()) return found;
  const ElementsPtr elements = surely_found_elements(features, task);
  if (!elements) return found;
  FoundLattice out = found;
  if (!are_in_step(*elements, l, true)) {
    if (const Lattice of_few = lattice_of_few(*elements, l); of_few.rank > 0)
      out.lattice = of_few;
    else if (l.rank < 2 && joints_cross(*elements))
      out.lattice = {2, {double(size.width), 0}, {0, double(size.height)}, 1};
  }
  if (out.lattice.is_single_cell(size)) out.courses = count_courses(*elements, features);
  return out;
}

FoundLattice find_lattice(const Features& features, double least_certainty, const Task& task) {
  const std::shared_ptr<const Planes> planes = weighted_planes(features, task);
  FoundLattice found =
      find_lattice({view_of(*planes, allowed_pixels(features), whole(features.size()))}, least_certainty, task);
  if (!features.mask()) found = told_by_one_cell(*planes, found, least_certainty, task);
  if (found.has_lines && features.wraps()) found = told_by_few_elements(features, found, task);
  if (found.lattice.rank > 1 || found.by_lines.rank == 0 || features.mask()) return found;
  const ElementsPtr elements = surely_found_elements(features, task);
  const int courses = elements ? count_courses(*elements, features) : 0;
  if (found.lattice.rank == 1 && courses > 0) return found;  // boards, say, whose joints are as long
  found.lattice = found.by_lines;
  if (found.lattice.is_single_cell(features.size())) found.courses = courses;
  return found;
}

}  // namespace terrazzo
