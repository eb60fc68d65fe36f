#include "core/synthesis/state/proximity_penalty.h"

#include <algorithm>
#include <limits>

#include <tbb/parallel_for.h>

#include "core/base/tuning.h"
#include "core/synthesis/state/cost_factor.h"

namespace terrazzo {

namespace {

struct ProximityPenaltyTuning {
  double most_excess = 2;
  double most_counts = double(1 << 24);
  int blocks_per_side = 8;
  int far_reach = 3;
  int near_reach = 2;
  int cells_per_side = 16;
  int smallest_cell = 2;
};
const Tunable<ProximityPenaltyTuning> proximity_penalty_tuning(
    "proximity_penalty",
    {
        {&ProximityPenaltyTuning::most_excess, "most_excess", "repeats near by",
         "higher: cells that repeat many times near by cost still more; lower: they are no worse than a few repeats",
         "not measured: keeps factors in the range of other terms"},
        {&ProximityPenaltyTuning::most_counts, "most_counts", "counters of two bytes",
         "higher: larger planes are counted too; costs memory and time", "not measured: 32 MiB"},
        {&ProximityPenaltyTuning::blocks_per_side, "blocks_per_side", "blocks along the exemplar's shorter side",
         "higher: a finer map of what is near, whose reaches are shorter; costs time and memory",
         "not measured: reaches were measured in eighths of the exemplar's side", 1},
        {&ProximityPenaltyTuning::far_reach, "far_reach", "blocks to each side",
         "higher: repeats must be farther apart, which drives them to one distance just beyond; lower: they come "
         "nearer",
         "proximity_penalty", 0, 100},
        {&ProximityPenaltyTuning::near_reach, "near_reach", "blocks to each side",
         "within it repeats count twice. Higher: more of them do; lower: repeats come side by side",
         "proximity_penalty", 0, 100},
        {&ProximityPenaltyTuning::cells_per_side, "cells_per_side", "cells along the exemplar's longer side",
         "higher: use is counted by smaller features; costs time. Lower: copies of parts of cells are not noticed",
         "not measured: chosen to be about as large as small features", 1},
        {&ProximityPenaltyTuning::smallest_cell, "smallest_cell", "pixels",
         "the least side of a cell. Higher: less time at coarse levels; lower: smaller features count there",
         "not measured: counts of single pixels would be mostly noise", 1},
    });

constexpr size_t cells_at_once = 16;  // compared together, which vectorizes
constexpr uint32_t most = std::numeric_limits<uint16_t>::max();

int block_side(Size exemplar) {
  return std::max(1, std::min(exemplar.width, exemplar.height) / proximity_penalty_tuning->blocks_per_side);
}

}  // namespace

ExemplarCells::ExemplarCells(Size exemplar) : columns(size_t(exemplar.width)), row_starts(size_t(exemplar.height)) {
  const int longer = std::max(exemplar.width, exemplar.height);
  const int side = std::max(proximity_penalty_tuning->smallest_cell, longer / proximity_penalty_tuning->cells_per_side);
  const int across = (exemplar.width + side - 1) / side, down = (exemplar.height + side - 1) / side;
  for (int x = 0; x < exemplar.width; x++) columns[x] = uint32_t(x / side);
  for (int y = 0; y < exemplar.height; y++) row_starts[y] = uint32_t(y / side * across);
  count = size_t(across) * down;
}

ProximityPenalty::ProximityPenalty(Size exemplar, std::vector<double> areas, double weight, const Plane& plane)
    : exemplar_(exemplar),
      areas_(std::move(areas)),
      weight_(weight),
      plane_(plane),
      cells_(areas_.size()),
      side_(block_side(exemplar)),
      columns_((plane.size.width + side_ - 1) / side_),
      rows_((plane.size.height + side_ - 1) / side_) {}

bool ProximityPenalty::is_worth_it(Size exemplar, const ExemplarCells& cells, const Plane& plane) {
  const double side = block_side(exemplar);
  return double(plane.size.area()) / (side * side) * double(cells.count) <= proximity_penalty_tuning->most_counts;
}

void ProximityPenalty::count(const Field& field, const ExemplarCells& cells) {
  count_shown(field, cells);
  factors_.assign(shown_.size(), unit_factor);
  for (const int reach : {proximity_penalty_tuning->far_reach, proximity_penalty_tuning->near_reach}) {
    sum_around(reach);
    raise_factors(reach);
  }
}

void ProximityPenalty::count_shown(const Field& field, const ExemplarCells& cells) {
  shown_.assign(size_t(columns_) * rows_ * cells_, 0);
  tbb::parallel_for(0, rows_, [&](int row) {
    for (int y = row * side_; y < std::min(field.size.height, (row + 1) * side_); y++)
      for (int x = 0; x < field.size.width; x++) shown_[block(x, y) * cells_ + cells.of(field.at(x, y))]++;
  });
}

/// Sums the counts of the blocks up to `reach` from each block of a line.
void ProximityPenalty::sum_along(const Line& line, int reach, const Counts& counts, Counts& sums) const {
  std::vector<uint32_t> sum(cells_, 0);
  const auto counts_at = [&](int i) { return &counts[size_t(line.first + wrap(i, line.length) * line.step) * cells_]; };
  const auto holds = [&](int i) { return line.closed || (i >= 0 && i < line.length); };
  const auto add = [&](int i) {
    const uint16_t* from = counts_at(i);
    for (size_t c = 0; c < cells_; c++) sum[c] += from[c];
  };
  const auto take_away = [&](int i) {
    const uint16_t* from = counts_at(i);
    for (size_t c = 0; c < cells_; c++) sum[c] -= from[c];
  };
  const bool all = line.closed && 2 * reach + 1 >= line.length;  // the whole line, each block once
  for (int i = all ? 0 : -reach; i < (all ? line.length : reach); i++)
    if (holds(i)) add(i);
  for (int i = 0; i < line.length; i++) {
    if (!all && holds(i + reach)) add(i + reach);
    uint16_t* to = &sums[size_t(line.first + i * line.step) * cells_];
    for (size_t c = 0; c < cells_; c++) to[c] = uint16_t(std::min(most, sum[c]));
    if (!all && holds(i - reach)) take_away(i - reach);
  }
}

void ProximityPenalty::sum_around(int reach) {
  across_.resize(shown_.size());
  sums_.resize(shown_.size());
  tbb::parallel_for(0, rows_, [&](int row) {
    sum_along({row * columns_, 1, columns_, plane_.tile_x}, reach, shown_, across_);
  });
  tbb::parallel_for(0, columns_, [&](int column) {
    sum_along({column, columns_, rows_, plane_.tile_y}, reach, across_, sums_);
  });
}

void ProximityPenalty::raise_factors(int reach) {
  // Where the reach covers more than the exemplar, everything may show more than once.
  const double looked_at = double(2 * reach + 1) * side_, area = double(exemplar_.area());
  const double times = std::max(1.0, looked_at * looked_at / area);
  std::vector<double> once(cells_);
  const double most_excess = proximity_penalty_tuning->most_excess;
  Counts whole_once(
      cells_);  // the same rounded down: most counts do not exceed it, and a vector of them is tested at once
  for (size_t c = 0; c < cells_; c++) {
    once[c] = std::max(1.0, areas_[c] * times);
    whole_once[c] = uint16_t(std::min(double(most), once[c]));
  }
  tbb::parallel_for(size_t{0}, sums_.size() / cells_, [&](size_t block) {
    const uint16_t* sums = &sums_[block * cells_];
    uint16_t* factors = &factors_[block * cells_];
    for (size_t first = 0; first < cells_; first += cells_at_once) {
      const size_t end = std::min(cells_, first + cells_at_once);
      bool any = false;
      for (size_t c = first; c < end; c++) any |= sums[c] > whole_once[c];
      if (!any) continue;
      for (size_t c = first; c < end; c++) {
        if (sums[c] <= whole_once[c]) continue;
        const double excess = std::max(0.0, sums[c] / once[c] - 1);
        factors[c] = uint16_t(std::min(double(most), factors[c] * (1 + weight_ * std::min(most_excess, excess))));
      }
    }
  });
}

}  // namespace terrazzo
