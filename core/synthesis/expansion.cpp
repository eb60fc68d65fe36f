#include "core/synthesis/expansion.h"

#include <algorithm>
#include <cmath>

namespace terrazzo {

namespace {

constexpr double fraction = 16;  // mismatches are integers of this part of a unit

}  // namespace

int64_t ExpansionGround::mismatch(ExemplarPixel a, ExemplarPixel b, int side) const {
  const PaddedLevel& e = level.exemplar;
  const int dx = sides[side][0], dy = sides[side][1];
  int u = a.x + dx, v = a.y + dy;
  e.settle_inside(u, v);
  if (u == b.x && v == b.y) return 0;
  const double here = squared_distance(*e.at(a.x, a.y), *e.at(b.x - dx, b.y - dy));
  const double there = squared_distance(*e.at(a.x + dx, a.y + dy), *e.at(b.x, b.y));
  // Roots make it a metric, without which a cut is not the best way to expand.
  return int64_t((std::sqrt(here) + std::sqrt(there)) * fraction);
}

void Expansion::keep(int pixel) {
  ground_.node[size_t(pixel)] = ExpansionGround::kept;
  kept_.push_back(pixel);
}

bool Expansion::offer(int pixel, ExemplarPixel shown) {
  if (ground_.node[size_t(pixel)] != ExpansionGround::untouched || ground_.field.pixels[size_t(pixel)] == shown ||
      ground_.level.fixed.at(size_t(pixel)))
    return false;
  ground_.node[size_t(pixel)] = int(free_.size());
  free_.push_back({pixel, shown});
  return true;
}

void Expansion::apply() {
  cut_.reset(int(free_.size()));
  for (size_t n = 0; n < free_.size(); n++) connect(int(n));
  cut_.solve();
  for (size_t n = 0; n < free_.size(); n++) {
    if (cut_.on_source_side(int(n))) ground_.field.pixels[free_[n].pixel] = free_[n].offered;
    ground_.node[free_[n].pixel] = ExpansionGround::untouched;
  }
  for (const int i : kept_) ground_.node[size_t(i)] = ExpansionGround::untouched;
  free_.clear();
  kept_.clear();
}

void Expansion::connect(int n) {
  const Free& f = free_[size_t(n)];
  const ExemplarPixel kept = ground_.field.pixels[f.pixel];
  const PlaneWindow& window = ground_.level.window;
  for (int side = 0; side < 4; side++) {
    const int64_t m = pixel_beside(ground_.field.size, f.pixel, side, window.closed_x, window.closed_y);
    if (m < 0) continue;
    const ExemplarPixel other = ground_.field.pixels[size_t(m)];
    const int node = ground_.node[size_t(m)];
    if (node < 0) {
      cut_.prefer_source(n, ground_.mismatch(kept, other, side) - ground_.mismatch(f.offered, other, side));
    } else if (side < 2) {  // free as well; each pair once
      const ExemplarPixel offered = free_[size_t(node)].offered;
      const int64_t neither = ground_.mismatch(kept, other, side), first = ground_.mismatch(f.offered, other, side),
                    second = ground_.mismatch(kept, offered, side), both = ground_.mismatch(f.offered, offered, side);
      cut_.prefer_source(n, neither - first);
      cut_.prefer_source(node, first - both);
      cut_.join(n, side, node, 0);
      cut_.join(node, side + 2, n, std::max<int64_t>(0, first + second - neither - both));
    }
  }
}

}  // namespace terrazzo
