#include "core/synthesis/seams.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "core/synthesis/grid_cut.h"
#include "core/synthesis/pieces.h"

namespace terrazzo {

namespace {

constexpr int smallest_piece = 2;  // pixels; smaller ones only give way
constexpr double fraction = 16;    // mismatches are integers of this part of a unit

/// What all movers work on. Those of pieces whose reaches do not meet can work at the same time.
struct Ground {
  static constexpr int beyond_reach = -1, in_piece = -2;

  Ground(Field& f, const CorrectionLevel& l, int r)
      : field(f), before(f), level(l), reach(r), node(f.pixels.size(), beyond_reach) {}

  Field& field;
  const Field before;
  const CorrectionLevel& level;
  int reach;
  std::vector<int> node;  // of each pixel in its mover's graph
};

class SeamMover {
 public:
  explicit SeamMover(Ground& ground)
      : field_(ground.field), before_(ground.before), level_(ground.level), reach_(ground.reach), node_(ground.node) {}

  void spread(std::span<const int> piece) {
    gather(piece);
    cut_.reset(int(free_.size()));
    for (size_t n = 0; n < free_.size(); n++) connect(int(n));
    cut_.solve();
    for (size_t n = 0; n < free_.size(); n++) {
      if (cut_.on_source_side(int(n))) field_.pixels[free_[n].pixel] = free_[n].spread;
      node_[free_[n].pixel] = beyond_reach;
    }
    for (const int i : inside_) node_[i] = beyond_reach;
  }

 private:
  static constexpr int beyond_reach = Ground::beyond_reach, in_piece = Ground::in_piece;
  /// A pixel that the piece may spread to, and what it would show then.
  struct Free {
    int pixel;
    ExemplarPixel spread;
  };

  int64_t beside(int pixel, int side) const {
    return pixel_beside(field_.size, pixel, side, level_.window.closed_x, level_.window.closed_y);
  }

  /// Whether the exemplar goes on there; moves to it.
  bool step(ExemplarPixel& p, int side) const {
    const int x = p.x + sides[side][0], y = p.y + sides[side][1];
    int u = x, v = y;
    if (!level_.exemplar.settles(u, v) || u != x || v != y) return false;
    p = {uint16_t(u), uint16_t(v)};
    return true;
  }

  /// What is left of the piece, and the pixels in its reach.
  void gather(std::span<const int> piece) {
    inside_.clear();
    free_.clear();
    std::vector<Free> rim, next;
    for (const int i : piece) {
      if (!(field_.pixels[i] == before_.pixels[i])) continue;
      node_[i] = in_piece;
      inside_.push_back(i);
      rim.push_back({i, field_.pixels[i]});
    }
    for (int r = 0; r < reach_; r++) {
      next.clear();
      for (const Free& f : rim)
        for (int side = 0; side < 4; side++) {
          const int64_t n = beside(f.pixel, side);
          if (n < 0 || node_[size_t(n)] != beyond_reach || level_.fixed.at(size_t(n))) continue;
          Free reached{int(n), f.spread};
          if (!step(reached.spread, side)) continue;
          node_[size_t(n)] = int(free_.size());
          free_.push_back(reached);
          next.push_back(reached);
        }
      rim.swap(next);
    }
  }

  /// What shows where a pixel shows a and its neighbour on that side b.
  int64_t mismatch(ExemplarPixel a, ExemplarPixel b, int side) const {
    const PaddedLevel& e = level_.exemplar;
    const int dx = sides[side][0], dy = sides[side][1];
    int u = a.x + dx, v = a.y + dy;
    e.settle_inside(u, v);
    if (u == b.x && v == b.y) return 0;
    const double here = squared_distance(*e.at(a.x, a.y), *e.at(b.x - dx, b.y - dy));
    const double there = squared_distance(*e.at(a.x + dx, a.y + dy), *e.at(b.x, b.y));
    // Roots make it a metric, without which a cut is not the best way to spread.
    return int64_t((std::sqrt(here) + std::sqrt(there)) * fraction);
  }

  void connect(int n) {
    const Free& f = free_[size_t(n)];
    const ExemplarPixel kept = field_.pixels[f.pixel];
    for (int side = 0; side < 4; side++) {
      const int64_t m = beside(f.pixel, side);
      if (m < 0) continue;
      const ExemplarPixel other = field_.pixels[size_t(m)];
      const int node = node_[size_t(m)];
      if (node < 0) {  // it stays
        cut_.prefer_source(n, mismatch(kept, other, side) - mismatch(f.spread, other, side));
      } else if (side < 2) {  // free as well; each pair once
        const ExemplarPixel spread = free_[size_t(node)].spread;
        const int64_t neither = mismatch(kept, other, side), first = mismatch(f.spread, other, side),
                      second = mismatch(kept, spread, side), both = mismatch(f.spread, spread, side);
        cut_.prefer_source(n, neither - first);
        cut_.prefer_source(node, first - both);
        cut_.join(n, side, node, 0);
        cut_.join(node, side + 2, n, std::max<int64_t>(0, first + second - neither - both));
      }
    }
  }

  Field& field_;
  const Field& before_;
  const CorrectionLevel& level_;
  int reach_;
  std::vector<int>& node_;
  std::vector<int> inside_;  // the piece
  std::vector<Free> free_;
  GridCut cut_;
};

/// Pieces that spread one after the other, put into rounds: those of a round lie so far apart that it does not matter
/// which comes first, and all that come earlier and lie near are in earlier rounds.
class Rounds {
 public:
  Rounds(const Field& field, const PlaneWindow& window, int reach)
      : size_(field.size),
        window_(window),
        side_(reach + 1),
        cells_{(size_.width + side_ - 1) / side_, (size_.height + side_ - 1) / side_},
        last_(size_t(cells_.area()), 0) {}

  void add(int piece, std::span<const int> members) {
    int round = 0;
    for_each_near(members, [&](size_t cell) { round = std::max(round, last_[cell]); });
    for_each_near(members, [&](size_t cell) { last_[cell] = round + 1; });
    if (round == int(rounds_.size())) rounds_.emplace_back();
    rounds_[size_t(round)].push_back(piece);
  }
  const std::vector<std::vector<int>>& all() const { return rounds_; }

 private:
  /// Calls `visit` for the cells of the pixels and those beside them. Where the field wraps around, its last cells may
  /// be narrower than a reach: one more counts as beside.
  template <typename Visit>
  void for_each_near(std::span<const int> members, const Visit& visit) const {
    int previous = -1;
    for (const int i : members) {
      const int cx = i % size_.width / side_, cy = i / size_.width / side_, cell = cy * cells_.width + cx;
      if (cell == previous) continue;
      previous = cell;
      for (int dy = -2; dy <= 2; dy++)
        for (int dx = -2; dx <= 2; dx++) {
          const int64_t n = pixel_index(cells_, cx + dx, cy + dy, window_.closed_x, window_.closed_y);
          if (n >= 0) visit(size_t(n));
        }
    }
  }

  Size size_;
  const PlaneWindow& window_;
  int side_;
  Size cells_;
  std::vector<int> last_;  // the round after the last of each cell
  std::vector<std::vector<int>> rounds_;
};

}  // namespace

void move_seams(Field& field, const CorrectionLevel& level, int reach, const Task& task) {
  const Pieces pieces(field);
  std::vector<int> order(size_t(pieces.count()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return pieces.area(a) > pieces.area(b); });
  Rounds rounds(field, level.window, reach);
  for (const int piece : order)
    if (pieces.area(piece) >= smallest_piece) rounds.add(piece, pieces.members(piece));
  Ground ground(field, level, reach);
  tbb::enumerable_thread_specific<SeamMover> movers([&] { return SeamMover(ground); });
  for (const std::vector<int>& round : rounds.all())
    tbb::parallel_for(0, int(round.size()), [&](int i) {
      task.check();
      movers.local().spread(pieces.members(round[size_t(i)]));
    });
}

}  // namespace terrazzo
