#include "core/synthesis/seams.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/synthesis/grid_cut.h"
#include "core/synthesis/pieces.h"

namespace terrazzo {

namespace {

constexpr int smallest_piece = 2;  // pixels; smaller ones only give way
constexpr double fraction = 16;    // mismatches are integers of this part of a unit

class SeamMover {
 public:
  SeamMover(Field& field, const CorrectionLevel& level, int reach)
      : field_(field), before_(field), level_(level), reach_(reach), node_(field.pixels.size(), beyond_reach) {}

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
  static constexpr int beyond_reach = -1, in_piece = -2;
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
  const Field before_;
  const CorrectionLevel& level_;
  int reach_;
  std::vector<int> node_;    // of each pixel
  std::vector<int> inside_;  // the piece
  std::vector<Free> free_;
  GridCut cut_;
};

}  // namespace

void move_seams(Field& field, const CorrectionLevel& level, int reach, const Task& task) {
  const Pieces pieces(field);
  std::vector<int> order(size_t(pieces.count()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return pieces.area(a) > pieces.area(b); });
  SeamMover mover(field, level, reach);
  for (const int piece : order) {
    if (pieces.area(piece) < smallest_piece) break;
    task.check();
    mover.spread(pieces.members(piece));
  }
}

}  // namespace terrazzo
