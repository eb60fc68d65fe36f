#include "core/synthesis/placing.h"

#include <cmath>

#include <tbb/parallel_for.h>

#include "core/hash.h"

namespace terrazzo {

namespace {

constexpr int draws = 16;  // of a block that must fit

/// The exemplar position from which a block starts.
std::array<int, 2> random_start(const PaddedLevel& exemplar, int side, uint64_t bits) {
  if (exemplar.masked()) {
    const auto [u, v] = exemplar.place(bits);
    return {u - side / 2, v - side / 2};
  }
  const int keep_off = exemplar.keep_off();
  const auto start = [&](uint32_t half, int n) {
    return keep_off + int(below(half, uint32_t(std::max(1, n - side - 2 * keep_off))));
  };
  return {start(uint32_t(bits), exemplar.size().width), start(uint32_t(bits >> 32), exemplar.size().height)};
}

/// Where a mask or controls make some places better than others, the best of several.
std::array<int, 2> best_start(const PaddedLevel& exemplar, const LevelControl* control, Size output, const Rect& block,
                              int side, uint64_t seed) {
  const uint64_t bits = random_bits(seed, Purpose::blocks, block.x / side, block.y / side);
  if (!exemplar.masked() && !control) return random_start(exemplar, side, bits);
  std::array<int, 2> best{};
  uint64_t least = ~uint64_t{0};
  for (int draw = 0; draw < draws; draw++) {
    const std::array<int, 2> start = random_start(exemplar, side, random_bits(bits, draw));
    uint64_t misfit = 0;
    for (int y = 0; y < block.height; y++)
      for (int x = 0; x < block.width; x++) {
        int u = start[0] + x, v = start[1] + y;
        exemplar.settle(u, v);
        const int64_t pixel = int64_t{block.y + y} * output.width + block.x + x;
        if (control) misfit += control->cost(u, v, control->target(pixel));
        misfit += u != start[0] + x || v != start[1] + y;
      }
    if (misfit >= least) continue;
    least = misfit;
    best = start;
  }
  return best;
}

void place_block(Field& field, const Rect& block, std::array<int, 2> start, const PaddedLevel& exemplar) {
  for (int y = 0; y < block.height; y++)
    for (int x = 0; x < block.width; x++) {
      int u = start[0] + x, v = start[1] + y;
      exemplar.settle(u, v);
      field.at(block.x + x, block.y + y) = {uint16_t(u), uint16_t(v)};
    }
}

/// Moves a position by up to `amplitude` pixels each way, any number of times around an exemplar that tiles.
void displace(int& u, int& v, const PaddedLevel& exemplar, double amplitude, uint64_t bits) {
  u += int(std::floor(amplitude * (2 * unit_double(bits << 32) - 1) + 0.5));
  v += int(std::floor(amplitude * (2 * unit_double(bits) - 1) + 0.5));
  exemplar.unwind(u, v);
}

/// Brings the first pixel of a block to where all four lie in the exemplar and continue one another.
void settle_block(int& u, int& v, const PaddedLevel& exemplar) {
  u++, v++;
  exemplar.settle_inside(u, v);
  u--, v--;
  exemplar.settle_inside(u, v);
}

}  // namespace

Field random_blocks(Size size, const PaddedLevel& exemplar, const LevelControl* control, const PartPhases& phase,
                    uint64_t seed) {
  Field field{size, std::vector<ExemplarPixel>(size_t(size.area()))};
  const Size from = exemplar.size();
  const int side = std::max(4, std::min(from.width, from.height) / 4);
  for (int top = 0; top < size.height; top += side)
    for (int left = 0; left < size.width; left += side) {
      const Rect block = intersect(whole(size), {left, top, side, side});
      std::array<int, 2> start = best_start(exemplar, control, size, block, side, seed);
      phase.snap(left, top, start[0], start[1]);
      exemplar.unwind(start[0], start[1]);
      place_block(field, block, start, exemplar);
    }
  return field;
}

void scatter(Field& field, const PaddedLevel& exemplar, double amplitude, uint64_t seed, int level) {
  if (amplitude <= 0) return;
  for (int y = 0; y < field.size.height; y++)
    for (int x = 0; x < field.size.width; x++) {
      int u = field.at(x, y).x, v = field.at(x, y).y;
      displace(u, v, exemplar, amplitude, random_bits(seed, Purpose::jitter, level, x, y));
      exemplar.settle(u, v);
      field.at(x, y) = {uint16_t(u), uint16_t(v)};
    }
}

Field block_starts(const Field& parent, const PlaneWindow& window, const PaddedLevel& exemplar, const PartPhases& phase,
                   double amplitude, uint64_t seed, int level) {
  Field starts{parent.size, std::vector<ExemplarPixel>(parent.pixels.size())};
  tbb::parallel_for(0, parent.size.height, [&](int row) {
    for (int column = 0; column < parent.size.width; column++) {
      const ExemplarPixel p = parent.at(column, row);
      const int x = window.x(column), y = window.y(row);
      int u = 2 * p.x, v = 2 * p.y;
      if (amplitude > 0) displace(u, v, exemplar, amplitude, random_bits(seed, Purpose::jitter, level, x, y));
      // At the finest level pieces fit one another already; to round each to the lattice would undo that.
      if (level > 0 || amplitude > 0) phase.snap(2 * x, 2 * y, u, v);
      exemplar.unwind(u, v);
      settle_block(u, v, exemplar);
      starts.at(column, row) = {uint16_t(u), uint16_t(v)};
    }
  });
  return starts;
}

Field expanded(std::span<const ExemplarPixel> starts, const PlaneWindow& from, const PlaneWindow& to,
               const PaddedLevel& exemplar) {
  Field field{to.size(), std::vector<ExemplarPixel>(size_t(to.part.area()))};
  tbb::parallel_for(0, to.part.height, [&](int row) {
    const int y = to.part.y + row;
    const ExemplarPixel* line = &starts[size_t(from.row(y >> 1)) * from.part.width];
    for (int column = 0; column < to.part.width; column++) {
      const int x = to.part.x + column;
      const ExemplarPixel p = line[from.column(x >> 1)];
      int u = p.x + (x & 1), v = p.y + (y & 1);
      exemplar.settle(u, v);
      field.at(column, row) = {uint16_t(u), uint16_t(v)};
    }
  });
  return field;
}

}  // namespace terrazzo
