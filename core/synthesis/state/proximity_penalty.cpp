#include "core/synthesis/state/proximity_penalty.h"

#include <algorithm>
#include <limits>

#include <tbb/parallel_for.h>

#include "core/base/tuning.h"
#include "core/synthesis/state/cost_factor.h"

namespace terrazzo {

namespace {

struct ProximityPenaltyTuning {
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
        {&ProximityPenaltyTuning::most_counts, "most_counts", "counters of two bytes",
         "higher: larger planes are counted too; costs memory and time", "What each rule decides"},
        {&ProximityPenaltyTuning::blocks_per_side, "blocks_per_side", "blocks along the exemplar's shorter side",
         "higher: a finer map of what is near, whose reaches are shorter; costs time and memory",
         "What each rule decides", 1},
        {&ProximityPenaltyTuning::far_reach, "far_reach", "blocks to each side",
         "higher: repeats must be farther apart, which drives them to one distance just beyond; lower: they come "
         "nearer",
         "proximity_penalty", 0, 100},
        {&ProximityPenaltyTuning::near_reach, "near_reach", "blocks to each side",
         "within it repeats count twice. Higher: more of them do; lower: repeats come side by side",
         "proximity_penalty", 0, 100},
        {&ProximityPenaltyTuning::cells_per_side, "cells_per_side", "cells along the exemplar's longer side",
         "higher: use is counted by smaller features; costs time. Lower: copies of parts of cells are not noticed",
         "What each rule decides", 1},
        {&ProximityPenaltyTuning::smallest_cell, "smallest_cell", "pixels",
         "the least side of a cell. Higher: less time at coarse levels; lower: smaller features count there",
         "What each rule decides", 1},
    });

constexpr uint32_t most = std::numeric_limits<uint16_t>::max();

int nearby_reach(size_t r) {
  return r == 0 ? proximity_penalty_tuning->far_reach : proximity_penalty_tuning->near_reach;
}

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
  sum_rows();
  raise_factors();
}

void ProximityPenalty::count_shown(const Field& field, const ExemplarCells& cells) {
  shown_.assign(size_t(columns_) * rows_ * cells_, 0);
  tbb::parallel_for(0, rows_, [&](int row) {
    for (int y = row * side_; y < std::min(field.size.height, (row + 1) * side_); y++)
      for (int x = 0; x < field.size.width; x++) shown_[block(x, y) * cells_ + cells.of(field.at(x, y))]++;
  });
}

/// The sums of the counts of the blocks up to `reach` from a block, which moves along a line from its beginning.
class ProximityPenalty::LineSums {
 public:
  LineSums(const Counts& counts, const Line& line, int reach, size_t cells)
      : counts_(counts),
        line_(line),
        reach_(reach),
        whole_line_(line.closed && 2 * reach + 1 >= line.length),
        sums_(cells, 0) {
    for (int i = whole_line_ ? 0 : -reach; i < (whole_line_ ? line.length : reach); i++) add(i);
  }
  /// The block's sums, of each cell; `i`: one more each time.
  const uint32_t* at(int i) {
    if (!whole_line_) add(i + reach_);
    if (!whole_line_ && i > 0) take_away(i - reach_ - 1);
    return sums_.data();
  }

 private:
  const uint16_t* counts_at(int i) const {
    if (!line_.closed && (i < 0 || i >= line_.length)) return nullptr;
    return &counts_[size_t(line_.first + wrap(i, line_.length) * line_.step) * sums_.size()];
  }
  void add(int i) {
    if (const uint16_t* from = counts_at(i))
      for (size_t c = 0; c < sums_.size(); c++) sums_[c] += from[c];
  }
  void take_away(int i) {
    if (const uint16_t* from = counts_at(i))
      for (size_t c = 0; c < sums_.size(); c++) sums_[c] -= from[c];
  }

  const Counts& counts_;
  Line line_;
  int reach_;
  bool whole_line_;  // each block counts once
  std::vector<uint32_t> sums_;
};

void ProximityPenalty::sum_rows() {
  for (Counts& sums : row_sums_) sums.resize(shown_.size());
  tbb::parallel_for(0, rows_, [&](int row) {
    const Line line{row * columns_, 1, columns_, plane_.tile_x};
    for (size_t r = 0; r < row_sums_.size(); r++) {
      LineSums near_by(shown_, line, nearby_reach(r), cells_);
      for (int i = 0; i < columns_; i++) {
        const uint32_t* sums = near_by.at(i);
        uint16_t* to = &row_sums_[r][size_t(line.first + i) * cells_];
        for (size_t c = 0; c < cells_; c++) to[c] = uint16_t(std::min(most, sums[c]));
      }
    }
  });
}

/// Where a reach covers more than the exemplar, everything may show more than once.
std::vector<float> ProximityPenalty::weights(int reach) const {
  const double looked_at = double(2 * reach + 1) * side_;
  const double times = std::max(1.0, looked_at * looked_at / double(exemplar_.area()));
  std::vector<float> out(cells_);
  for (size_t c = 0; c < cells_; c++) out[c] = float(weight_ / std::max(1.0, areas_[c] * times));
  return out;
}

void ProximityPenalty::raise_factors() {
  factors_.resize(shown_.size());
  const std::vector<float> far_weights = weights(nearby_reach(0)), near_weights = weights(nearby_reach(1));
  const float base = float(1 - weight_);
  tbb::parallel_for(0, columns_, [&](int column) {
    const Line line{column, columns_, rows_, plane_.tile_y};
    LineSums far(row_sums_[0], line, nearby_reach(0), cells_), near(row_sums_[1], line, nearby_reach(1), cells_);
    for (int i = 0; i < rows_; i++) {
      const uint32_t *far_sums = far.at(i), *near_sums = near.at(i);
      uint16_t* to = &factors_[size_t(line.first + i * line.step) * cells_];
      // 1 up to one showing, then straight up; without branches, which vectorizes.
      const auto factor = [&](uint32_t sum, float weight) {
        return std::max(1.0f, base + weight * float(int32_t(sum)));
      };
      for (size_t c = 0; c < cells_; c++)
        to[c] = uint16_t(std::min(float(most), float(unit_factor) * factor(far_sums[c], far_weights[c]) *
                                                   factor(near_sums[c], near_weights[c])));
    }
  });
}

}  // namespace terrazzo
