#include "core/synthesis/state/proximity_penalty.h"

#include <algorithm>
#include <limits>

#include <tbb/parallel_for.h>

#include "core/synthesis/state/usage_penalty.h"

namespace terrazzo {

namespace {

constexpr int blocks_per_side = 8;  // of the exemplar
// How many blocks a place looks to each side of its own: seven eighths of the exemplar's side in all, and five, so that
// what is nearer counts twice. Looking farther drives what comes again to one and the same distance.
constexpr int reaches[] = {3, 2};
constexpr double most_excess = 2;
constexpr size_t cells_at_once = 16;
constexpr double most_counts = double(1 << 24);
constexpr uint32_t most = std::numeric_limits<uint16_t>::max();

int block_side(Size exemplar) {
  return std::max(1, std::min(exemplar.width, exemplar.height) / blocks_per_side);
}

}  // namespace

ExemplarCells::ExemplarCells(Size exemplar) : columns(size_t(exemplar.width)), row_starts(size_t(exemplar.height)) {
  const int side = std::max(2, std::max(exemplar.width, exemplar.height) / 16);
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
  return double(plane.size.area()) / (side * side) * double(cells.count) <= most_counts;
}

void ProximityPenalty::count(const Field& field, const ExemplarCells& cells) {
  count_shown(field, cells);
  factors_.assign(shown_.size(), unit_factor);
  for (const int reach : reaches) {
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

/// Adds up each block's counts and those of the blocks around it in a line.
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
  const bool all = line.closed && 2 * reach + 1 >= line.length;  // each once, whichever block asks
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
  // Of an exemplar smaller than what a place looks at, everything may come more often.
  const double looked_at = double(2 * reach + 1) * side_, area = double(exemplar_.area());
  const double times = std::max(1.0, looked_at * looked_at / area);
  std::vector<double> once(cells_);
  Counts whole_once(cells_);  // the same rounded down: most counts do not exceed it, which several at once tell soon
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
