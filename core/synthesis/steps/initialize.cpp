#include "core/synthesis/steps/initialize.h"

#include <array>
#include <cmath>
#include <vector>

#include <tbb/parallel_for.h>

#include "core/base/hash.h"
#include "core/base/tuning.h"
#include "core/synthesis/state/purpose.h"

namespace terrazzo {

namespace {

struct InitializeTuning {
  int blocks_per_side = 4;
  int steered_draws = 16;
  int free_draws = 4;
  int near_blocks = 3;
};
const Tunable<InitializeTuning> initialize_tuning(
    "initialize",
    {
        {&InitializeTuning::blocks_per_side, "blocks_per_side", "blocks along the exemplar's shorter side",
         "higher: smaller blocks mix more, and large features are cut; lower: large features stay whole and repeat",
         "What each rule decides", 1},
        {&InitializeTuning::steered_draws, "steered_draws", "random blocks",
         "under a mask or controls. Higher: the layout follows them more closely; lower: it varies more",
         "What each rule decides"},
        {&InitializeTuning::free_draws, "free_draws", "random blocks",
         "without them. Higher: less repeats near by, more at one distance just beyond; lower: blocks repeat side by "
         "side",
         "proximity_penalty"},
        {&InitializeTuning::near_blocks, "near_blocks", "blocks",
         "how far repeats count. Higher: they are pushed farther away; lower: they come nearer",
         "What each rule decides", 0, 100},
    });

/// The exemplar position of a random block's first pixel. Blocks end at the border, unless the exemplar tiles.
std::array<int, 2> random_start(const PaddedLevel& exemplar, int side, uint64_t bits) {
  if (exemplar.masked()) {
    const auto [u, v] = exemplar.place(bits);
    return {u - side / 2, v - side / 2};
  }
  if (exemplar.wraps()) return exemplar.place(bits);
  const int keep_off = exemplar.keep_off();
  const auto start = [&](uint32_t half, int n) {
    return keep_off + int(below(half, uint32_t(std::max(1, n - side - 2 * keep_off))));
  };
  return {start(uint32_t(bits), exemplar.size().width), start(uint32_t(bits >> 32), exemplar.size().height)};
}

/// Places one block after the other, each the best of several random ones.
class BlockPlacing {
 public:
  BlockPlacing(const CorrectionLevel& level, uint64_t seed)
      : level_(level),
        exemplar_(level.exemplar),
        plane_(level.window.plane),
        seed_(seed),
        side_(block_side(exemplar_.size())),
        blocks_{{(plane_.size.width + side_ - 1) / side_, (plane_.size.height + side_ - 1) / side_},
                plane_.tile_x,
                plane_.tile_y} {}

  Field field() {
    Field field{plane_.size, std::vector<ExemplarPixel>(size_t(plane_.size.area()))};
    for (int row = 0; row < blocks_.size.height; row++)
      for (int column = 0; column < blocks_.size.width; column++) {
        starts_.push_back(best_start(column, row));
        const Rect block = this->block(column, row);
        for (int y = 0; y < block.height; y++)
          for (int x = 0; x < block.width; x++) {
            int u = starts_.back()[0] + x, v = starts_.back()[1] + y;
            exemplar_.settle(u, v);
            field.at(block.x + x, block.y + y) = {uint16_t(u), uint16_t(v)};
          }
      }
    return field;
  }

 private:
  using Start = std::array<int, 2>;  // the exemplar position of a block's first pixel

  static int block_side(Size exemplar) {
    return std::max(1, std::min(exemplar.width, exemplar.height) / initialize_tuning->blocks_per_side);
  }

  bool steered() const { return level_.control || exemplar_.masked(); }
  Rect block(int column, int row) const {
    return intersect(whole(plane_.size), {column * side_, row * side_, side_, side_});
  }

  Start best_start(int column, int row) const {
    const uint64_t bits = random_bits(seed_, Purpose::blocks, column, row);
    Start best = start(column, row, bits);
    if (!steered() && level_.phase.active()) return best;  // cells of a lattice are meant to repeat
    double least = misfit(column, row, best);
    const int draws = steered() ? initialize_tuning->steered_draws : initialize_tuning->free_draws;
    for (int draw = 1; draw < draws && least > 0; draw++) {
      const Start other = start(column, row, random_bits(bits, draw));
      const double misfit = this->misfit(column, row, other);
      if (misfit >= least) continue;
      least = misfit;
      best = other;
    }
    return best;
  }

  Start start(int column, int row, uint64_t bits) const {
    Start start = random_start(exemplar_, side_, bits);
    level_.phase.snap(column * side_, row * side_, start[0], start[1]);
    exemplar_.unwind(start[0], start[1]);
    return start;
  }

  double misfit(int column, int row, const Start& start) const {
    return steered() ? steered_misfit(block(column, row), start) : shown_near(column, row, start);
  }

  /// What a block's pixels cost under a mask and controls.
  double steered_misfit(const Rect& block, const Start& start) const {
    uint64_t misfit = 0;
    for (int y = 0; y < block.height; y++)
      for (int x = 0; x < block.width; x++) {
        int u = start[0] + x, v = start[1] + y;
        exemplar_.settle(u, v);
        const int64_t pixel = int64_t{block.y + y} * plane_.size.width + block.x + x;
        if (level_.control) misfit += level_.control->cost(u, v, level_.control->target(pixel));
        misfit += u != start[0] + x || v != start[1] + y;
      }
    return double(misfit);
  }

  /// How many of a block's pixels the blocks placed so far show near by, weighted by nearness.
  double shown_near(int column, int row, const Start& start) const {
    const int near_blocks = initialize_tuning->near_blocks;
    double sum = 0;
    for (int down = -near_blocks; down <= near_blocks; down++)
      for (int across = -near_blocks; across <= near_blocks; across++) {
        const int64_t other = blocks_.index(column + across, row + down);
        if (other < 0 || other >= int64_t(starts_.size())) continue;
        int du = starts_[size_t(other)][0] - start[0], dv = starts_[size_t(other)][1] - start[1];
        if (exemplar_.wraps()) {
          du = nearest_to_zero(du, exemplar_.size().width);
          dv = nearest_to_zero(dv, exemplar_.size().height);
        }
        const int width = side_ - std::abs(du), height = side_ - std::abs(dv);
        if (width <= 0 || height <= 0) continue;
        const double dx = across * side_ - du, dy = down * side_ - dv;  // from a pixel to its repeat
        sum += double(width) * height * std::max(0.0, 1 - std::sqrt(dx * dx + dy * dy) / (near_blocks * side_));
      }
    return sum;
  }

  const CorrectionLevel& level_;
  const PaddedLevel& exemplar_;
  const Plane& plane_;
  uint64_t seed_;
  int side_;
  Plane blocks_;
  std::vector<Start> starts_;  // of the blocks that are placed
};

/// Displaces a position by up to `amplitude` pixels each way.
void displace(int& u, int& v, double amplitude, uint64_t bits) {
  u += int(std::floor(amplitude * (2 * unit_double(bits << 32) - 1) + 0.5));
  v += int(std::floor(amplitude * (2 * unit_double(bits) - 1) + 0.5));
}

/// Brings the first pixel of a block to where all four lie in the exemplar and continue one another.
void settle_block(int& u, int& v, const PaddedLevel& exemplar) {
  u++, v++;
  exemplar.settle_inside(u, v);
  u--, v--;
  exemplar.settle_inside(u, v);
}

}  // namespace

Field random_blocks(const CorrectionLevel& level, uint64_t seed) {
  return BlockPlacing(level, seed).field();
}

void scatter(Field& field, const CorrectionLevel& level, double amplitude, uint64_t seed) {
  if (amplitude <= 0) return;
  for (int y = 0; y < field.size.height; y++)
    for (int x = 0; x < field.size.width; x++) {
      int u = field.at(x, y).x, v = field.at(x, y).y;
      displace(u, v, amplitude, random_bits(seed, Purpose::jitter, level.level, x, y));
      level.exemplar.settle(u, v);
      field.at(x, y) = {uint16_t(u), uint16_t(v)};
    }
}

Field block_starts(const Field& parent, const CorrectionLevel& level, double amplitude, uint64_t seed) {
  Field starts{parent.size, std::vector<ExemplarPixel>(parent.pixels.size())};
  tbb::parallel_for(0, parent.size.height, [&](int row) {
    for (int column = 0; column < parent.size.width; column++) {
      const ExemplarPixel p = parent.at(column, row);
      const int x = level.window.x(column), y = level.window.y(row);
      int u = 2 * p.x, v = 2 * p.y;
      if (amplitude > 0) displace(u, v, amplitude, random_bits(seed, Purpose::jitter, level.level, x, y));
      // At the finest level pieces fit one another already; to snap each to the lattice would undo that, unless the
      // lattice is exact to the pixel.
      if (level.level > 0 || amplitude > 0 || level.phase.is_whole()) level.phase.snap(2 * x, 2 * y, u, v);
      settle_block(u, v, level.exemplar);
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
