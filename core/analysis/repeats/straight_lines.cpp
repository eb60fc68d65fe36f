#include "core/analysis/repeats/straight_lines.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "core/base/tuning.h"
#include "core/image/line_changes.h"

namespace terrazzo {

namespace {

struct StraightLinesTuning {
  double least_crossing = 0.1;
  double recurring = 0.5;
  double same_step = 0.75;
  double least_parallel = 0.4;
  double same_lines = 0.7;
  double other_lines = 0.3;
  double other_strong_lines = 0.5;
  double least_beside = 0.5;
  double least_missed = 0.05;
  double least_sharp = 0.02;
  double nearly_all = 0.6;
  double least_lasting = 0.04;
  double least_straight = 0.3;
  double least_straight_if_cut = 0.5;
  int most_repeats = 8;
};
const Tunable<StraightLinesTuning> straight_lines_tuning(
    "straight_lines",
    {
        {&StraightLinesTuning::least_crossing, "least_crossing", "share of the variance",
         "what must differ from line to line along both axes. Higher: fewer tiles are seen; lower: layers of rock are "
         "taken for them",
         "regularity"},
        {&StraightLinesTuning::recurring, "recurring", "factor",
         "on that where lines come twice and more along both axes, one of them as often as bands do. Higher: thin "
         "joints are torn; lower: chance lines make tiles",
         "regularity", 0, 1},
        {&StraightLinesTuning::same_step, "same_step", "share of the correlation",
         "of joints a step along and down that either alone must have, or they are a bond. Higher: worn tiles are "
         "laid as bricks; lower: bricks are laid as tiles",
         "regularity", 0, 1},
        {&StraightLinesTuning::least_parallel, "least_parallel", "share of the variance",
         "the same along one axis only. Higher: fewer boards are seen; lower: layers of rock are taken for them",
         "What each rule decides"},
        {&StraightLinesTuning::same_lines, "same_lines", "correlation",
         "of lines that repeat. Higher: the lines of an exemplar are taken to differ; lower: different ones are taken "
         "to repeat",
         "What each rule decides"},
        {&StraightLinesTuning::other_lines, "other_lines", "correlation",
         "up to which lines deny bands found otherwise. Higher: they deny more; lower: wrong bands stay",
         "What each rule decides"},
        {&StraightLinesTuning::other_strong_lines, "other_strong_lines", "correlation",
         "the same of lines that could part cells by themselves. Higher: results repeat larger parts; lower: panels of "
         "which some are two cells wide are cut",
         "regularity", 0, 1},
        {&StraightLinesTuning::least_beside, "least_beside", "of the share of lines as bands have",
         "that others across them must hold to part those into cells. Higher: panels over a rail are torn; lower: "
         "boards with few head joints are cells",
         "regularity", 0, 10},
        {&StraightLinesTuning::least_missed, "least_missed", "share of the variance",
         "of lines that cells found otherwise miss. Higher: frames around a fine pattern are torn; lower: results "
         "repeat larger parts",
         "regularity", 0, 1},
        {&StraightLinesTuning::least_sharp, "least_sharp", "share of the lines' variance",
         "that lies between neighbours, along both axes, where lines part cells. Higher: soft frames are torn; lower: "
         "clouds are repeated",
         "regularity", 0, 1},
        {&StraightLinesTuning::nearly_all, "nearly_all", "share of the variance",
         "that bands which come once hold. Higher: painted stripes are cut; lower: rock with a dark edge comes in rows",
         "regularity", 0, 1},
        {&StraightLinesTuning::least_lasting, "least_lasting", "share of all changes",
         "that stay along half of the exemplar, in both directions, if long lines cross. Higher: unequal panels are "
         "torn; lower: courses of a few bricks are repeated",
         "long_lines", 0, 1},
        {&StraightLinesTuning::least_straight, "least_straight", "share of the changes along short runs",
         "that stay along those of half the exemplar, if lines are straight. Higher: unequal panels are torn; lower: "
         "clouds and blobs are repeated",
         "long_lines", 0, 1},
        {&StraightLinesTuning::least_straight_if_cut, "least_straight_if_cut", "share of the changes along short runs",
         "the same of an exemplar that does not tile. Higher: panels that its border cuts are torn; lower: stones and "
         "doors are repeated with its borders",
         "long_lines", 0, 1},
        {&StraightLinesTuning::most_repeats, "most_repeats", "lines in an exemplar",
         "higher: narrower lines are found to repeat; lower: less chance", "What each rule decides"},
    });

/// What of all variance is differences between lines along one axis, and after how many pixels lines come again.
struct StraightLines {
  double share = 0;
  double period = 0;
  std::vector<double> profile;
  double sharp = 0;  ///< what of their variance lies between neighbours: clouds fade over many lines, joints do not

  int count() const { return int(double(profile.size()) / period + 0.5); }
  bool recurs_after(double distance) const { return count() > 1 && distance == period; }
};

double correlation_around(const std::vector<double>& profile, double lag) {
  const auto n = int(profile.size());
  const auto at_lag = [&](int d) {
    double sum = 0;
    for (int i = 0; i < n; i++) sum += profile[i] * profile[(i + d) % n];
    return sum;
  };
  const int d = int(std::floor(lag + 0.5));
  const double most = std::max({at_lag(d + n - 1), at_lag(d), at_lag(d + 1)});
  return most / std::max(1e-12, at_lag(0));
}

/// Of lines one or several periods apart, up to half the exemplar: those of one broad band are alike after one.
double least_correlation(const std::vector<double>& profile, double period) {
  double least = 1;
  for (double lag = period; lag <= std::max(period, double(profile.size()) / 2); lag += period)
    least = std::min(least, correlation_around(profile, lag));
  return least;
}

/// Without the period.
StraightLines shares_of(const Planes& plane, bool rows) {
  const int width = plane.size.width, height = plane.size.height;
  const double mean = std::accumulate(plane.values.begin(), plane.values.end(), 0.0) / double(plane.values.size());
  std::vector<double> profile(size_t(rows ? height : width), 0.0);
  double variance = 0;
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      const double v = plane.values[size_t(y) * width + x] - mean;
      variance += v * v;
      profile[size_t(rows ? y : x)] += v;
    }
  const double length = rows ? width : height, count = double(profile.size());
  double between = 0;
  for (const double v : profile) between += v * v / length;
  double steps = 0, squares = 0;
  for (size_t i = 0; i < profile.size(); i++) {
    const bool ends = i + 1 == profile.size();
    const double step = ends && !plane.wraps ? 0 : profile[ends ? 0 : i + 1] - profile[i];
    steps += step * step / 2;
    squares += profile[i] * profile[i];
  }
  return {between / std::max(1e-12, variance), count, std::move(profile), steps / std::max(1e-12, squares)};
}

StraightLines straight_lines_of(const Planes& plane, bool rows) {
  StraightLines out = shares_of(plane, rows);
  const std::vector<double>& profile = out.profile;
  const double count = out.period;
  for (int n = 2; n <= straight_lines_tuning->most_repeats; n++) {
    double least = 1;
    for (int k = 1; k < n; k++) least = std::min(least, correlation_around(profile, k * count / n));
    if (least >= straight_lines_tuning->same_lines) out.period = count / n;
  }
  return out;
}

/// The correlation up to which lines deny what was found otherwise.
double most_unlike(const StraightLines& lines) {
  return lines.share >= straight_lines_tuning->least_crossing ? straight_lines_tuning->other_strong_lines
                                                              : straight_lines_tuning->other_lines;
}

/// Cells that come as often as lines do which finer ones miss: seams between plates with a fine pattern. Rank 0 if none
/// are missed.
Lattice with_missed_lines(const Lattice& found, const StraightLines& rows, const StraightLines& columns) {
  // Of threads of a few pixels, lines tell nothing.
  const auto misses = [](const StraightLines& lines, double step) {
    return step >= 1.5 * shortest_repeat() && step < lines.period &&
           lines.share >= straight_lines_tuning->least_missed &&
           least_correlation(lines.profile, step) <= most_unlike(lines);
  };
  const double along = std::abs(found.along_bands(true).x()), across = std::abs(found.along_bands(false).y());
  const bool by_rows = misses(rows, across), by_columns = misses(columns, along);
  if (!by_rows && !by_columns) return {};
  return {2, {by_columns ? columns.period : along, 0}, {0, by_rows ? rows.period : across}, found.certainty};
}

}  // namespace

Lattice lattice_of_lines(const Planes& outlines, const Correlation& joints, const Lattice& found) {
  const StraightLines rows = straight_lines_of(outlines, true), columns = straight_lines_of(outlines, false);
  if (found.rank > 1) return with_missed_lines(found, rows, columns);
  const Vector2d down{0, rows.period}, right{columns.period, 0};
  const bool courses = rows.share >= straight_lines_tuning->least_parallel;
  // Where nothing else repeats, and lines of one axis are not enough for courses, they make up for few of the other.
  const bool together = found.rank == 0 && std::max(rows.share, columns.share) < straight_lines_tuning->least_parallel;
  const double both = together ? std::sqrt(rows.share * columns.share) : std::min(rows.share, columns.share);
  // Lines that bands found otherwise miss, or agree with, need not be surer than those. Thin joints are little of all
  // there is, but tell if the lines of both axes recur and bands come as often as one of them.
  const StraightLines& of_bands = found.first.x() == 0 ? rows : columns;
  const double bands = found.first.sum();
  const StraightLines& beside = found.first.x() == 0 ? columns : rows;
  const bool agree = found.rank == 1 && of_bands.recurs_after(bands);
  const bool missed = found.rank == 1 && !agree && least_correlation(of_bands.profile, bands) <= most_unlike(of_bands);
  const bool recur = agree && rows.count() > 1 && columns.count() > 1;
  const double least = straight_lines_tuning->least_crossing * (recur ? straight_lines_tuning->recurring : 1);
  const bool in_bands = agree && beside.share >= straight_lines_tuning->least_beside * of_bands.share;
  const bool sharp = std::min(rows.sharp, columns.sharp) >= straight_lines_tuning->least_sharp;
  const bool enough = sharp && both >= least && (recur || in_bands || missed || both >= found.certainty);
  if (enough) {
    // Of bricks in a bond every second course, and every second line of its joints, is alike.
    const Vector2d diagonal = right + down;
    const bool bond =
        recur && rows.count() % 2 == 0 && columns.count() % 2 == 0 &&
        std::min(joints.at(right), joints.at(down)) < straight_lines_tuning->same_step * joints.at(diagonal);
    // Thin joints that recur are as sure as others must be.
    const double certainty = std::max(both, straight_lines_tuning->least_crossing);
    return {2, bond ? Vector2d(2 * right) : right, bond ? diagonal : down, certainty};
  }
  const StraightLines& lines = courses ? rows : columns;
  if (lines.share < straight_lines_tuning->least_parallel) return {};
  // Bands found otherwise stay, unless lines deny them.
  const double period = courses ? found.first.y() : found.first.x();
  if (found.rank == 1 && (period == 0 || correlation_around(lines.profile, period) > most_unlike(lines))) return {};
  return {1, courses ? down : right, {}, lines.share};
}

Lattice lattice_of_crossing_lines(const Planes& planes, const Planes& outlines, double bands, const Task& task) {
  const int side = std::max(std::min(planes.size.width, planes.size.height), int(6 * bands));
  const LineChanges rows = line_changes(planes, true, side, task), columns = line_changes(planes, false, side, task);
  const double least = straight_lines_tuning->least_lasting * (rows.single + columns.single);
  const double straight =
      planes.wraps ? straight_lines_tuning->least_straight : straight_lines_tuning->least_straight_if_cut;
  for (const LineChanges& c : {rows, columns})
    if (c.lasting <= least || c.lasting < straight * c.brief) return {};
  const StraightLines down = straight_lines_of(outlines, true), along = straight_lines_of(outlines, false);
  if (std::min(down.sharp, along.sharp) < straight_lines_tuning->least_sharp) return {};
  if (!planes.wraps) return {2, {double(planes.size.width), 0}, {0, double(planes.size.height)}, 1};
  return {2, {along.period, 0}, {0, down.period}, 1};
}

Lattice lattice_of_single_bands(const ExemplarView& view, const Planes& outlines, const Lattice& found,
                                const Task& task) {
  const Planes leading{view.planes.size, 1, view.planes.wraps, leading_component(view.planes, task)};
  const StraightLines rows = straight_lines_of(leading, true), columns = straight_lines_of(leading, false);
  const bool courses = rows.share >= columns.share;
  const StraightLines& lines = courses ? rows : columns;
  if (lines.share < straight_lines_tuning->nearly_all) return {};
  if (!has_edges_between(outlines, courses)) return {};
  const double period = found.rank == 0 ? 0 : courses ? found.first.y() : found.first.x();
  // Shades of courses may differ where their joints repeat.
  const StraightLines edges = shares_of(outlines, courses);
  if (period > 0)
    for (const std::vector<double>& profile : {lines.profile, edges.profile})
      if (least_correlation(profile, period) > straight_lines_tuning->other_lines) return {};
  return {1, courses ? Vector2d{0, lines.period} : Vector2d{lines.period, 0}, {}, lines.share};
}

double least_of_lines() {
  return straight_lines_tuning->least_crossing;
}

bool has_edges_between(const Planes& outlines, bool rows) {
  return shares_of(outlines, rows).share >= least_of_lines();
}

bool lines_cross(const Planes& outlines) {
  const auto [less, more] = std::minmax({shares_of(outlines, true).share, shares_of(outlines, false).share});
  const bool is_framed =
      more >= straight_lines_tuning->least_parallel && less >= straight_lines_tuning->recurring * least_of_lines();
  return less >= least_of_lines() || is_framed;
}

bool has_lines(const Planes& outlines) {
  return has_edges_between(outlines, true) || has_edges_between(outlines, false);
}

}  // namespace terrazzo
