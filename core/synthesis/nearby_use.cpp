#include "core/synthesis/nearby_use.h"

#include <algorithm>
#include <limits>

#include <tbb/parallel_for.h>

#include "core/synthesis/occupancy.h"

namespace terrazzo {

namespace {

constexpr int blocks_per_side = 8;  // of the exemplar
// How many blocks a place looks to each side of its own: seven eighths of the exemplar's side in all, and five, so that
// what is nearer counts twice. Looking farther drives what comes again to one and the same distance.
constexpr int reaches[] = {3, 2};
constexpr double most_excess = 2;
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

NearbyUse::NearbyUse(Size exemplar, std::vector<double> areas, double weight, const Plane& plane)
    : exemplar_(exemplar),
      areas_(std::move(areas)),
      weight_(weight),
      plane_(plane),
      cells_(areas_.size()),
      side_(block_side(exemplar)),
      columns_((plane.size.width + side_ - 1) / side_),
      rows_((plane.size.height + side_ - 1) / side_) {}

bool NearbyUse::is_worth_it(Size exemplar, const ExemplarCells& cells, const Plane& plane) {
  const double side = block_side(exemplar);
  return double(plane.size.area()) / (side * side) * double(cells.count) <= most_counts;
}

void NearbyUse::count(const Field& field, const ExemplarCells& cells) {
  const Counts counts = shown(field, cells);
  factors_.assign(counts.size(), unit_factor);
  for (const int reach : reaches) raise_factors(sums_around(counts, reach), reach);
}

/// What every block shows.
NearbyUse::Counts NearbyUse::shown(const Field& field, const ExemplarCells& cells) const {
  Counts counts(size_t(columns_) * rows_ * cells_, 0);
  tbb::parallel_for(0, rows_, [&](int row) {
    for (int y = row * side_; y < std::min(field.size.height, (row + 1) * side_); y++)
      for (int x = 0; x < field.size.width; x++) counts[block(x, y) * cells_ + cells.of(field.at(x, y))]++;
  });
  return counts;
}

/// Adds up each block's counts and those of the blocks around it in a line.
void NearbyUse::sum_along(const Line& line, int reach, const Counts& counts, Counts& sums) const {
  std::vector<uint32_t> sum(cells_);
  const bool all = line.closed && 2 * reach + 1 >= line.length;
  for (int i = 0; i < line.length; i++) {
    std::ranges::fill(sum, 0);
    const int first = all ? 0 : line.closed ? i - reach : std::max(0, i - reach);
    const int last = all ? line.length - 1 : line.closed ? i + reach : std::min(line.length - 1, i + reach);
    for (int other = first; other <= last; other++) {
      const uint16_t* from = &counts[size_t(line.first + wrap(other, line.length) * line.step) * cells_];
      for (size_t c = 0; c < cells_; c++) sum[c] += from[c];
    }
    uint16_t* to = &sums[size_t(line.first + i * line.step) * cells_];
    for (size_t c = 0; c < cells_; c++) to[c] = uint16_t(std::min(most, sum[c]));
  }
}

NearbyUse::Counts NearbyUse::sums_around(const Counts& counts, int reach) const {
  Counts across(counts.size()), sums(counts.size());
  tbb::parallel_for(0, rows_, [&](int row) {
    sum_along({row * columns_, 1, columns_, plane_.tile_x}, reach, counts, across);
  });
  tbb::parallel_for(0, columns_, [&](int column) {
    sum_along({column, columns_, rows_, plane_.tile_y}, reach, across, sums);
  });
  return sums;
}

void NearbyUse::raise_factors(const Counts& sums, int reach) {
  // Of an exemplar smaller than what a place looks at, everything may come more often.
  const double looked_at = double(2 * reach + 1) * side_, area = double(exemplar_.area());
  const double times = std::max(1.0, looked_at * looked_at / area);
  std::vector<double> once(cells_);
  for (size_t c = 0; c < cells_; c++) once[c] = std::max(1.0, areas_[c] * times);
  tbb::parallel_for(size_t{0}, sums.size() / cells_, [&](size_t block) {
    for (size_t c = 0; c < cells_; c++) {
      const double excess = sums[block * cells_ + c] / once[c] - 1;
      if (excess <= 0) continue;
      uint16_t& factor = factors_[block * cells_ + c];
      factor = uint16_t(std::min(double(most), factor * (1 + weight_ * std::min(most_excess, excess))));
    }
  });
}

}  // namespace terrazzo
