#include "core/synthesis/state/piece_seams.h"

#include <algorithm>

namespace terrazzo {

bool PieceGround::is_fixed(int piece) const {
  if (!level_.fixed.any()) return false;
  const std::span<const int> members = pieces_.members(piece);
  return std::any_of(members.begin(), members.end(), [&](int i) { return level_.fixed.at(size_t(i)); });
}

bool PieceGround::has_room(int piece, int dx, int dy) const {
  const std::span<const int> members = pieces_.members(piece);
  return std::all_of(members.begin(), members.end(), [&](int i) {
    const ExemplarPixel p = field_.pixels[size_t(i)];
    const int x = p.x + dx, y = p.y + dy, far = block_ - 1;
    return level_.exemplar.holds(x, y) && level_.exemplar.holds(x + far, y + far);
  });
}

int64_t PieceGround::mismatch(const PieceSeams& seams, int dx, int dy, int64_t limit) const {
  const PaddedLevel& e = level_.exemplar;
  int64_t sum = 0;
  for (const PieceSeam& s : seams) {
    int u = s.inside.x + dx, v = s.inside.y + dy;
    e.settle(u, v);
    sum += squared_distance(*e.at(u, v), *e.at(s.beyond.x - s.dx, s.beyond.y - s.dy));
    sum += squared_distance(*e.at(u + s.dx, v + s.dy), *e.at(s.beyond.x, s.beyond.y));
    if (sum >= limit) break;
  }
  return sum;
}

double PieceGround::penalty(int piece, int dx, int dy) const {
  if (!level_.phase.active()) return 1;
  const int i = pieces_.members(piece)[0];
  const ExemplarPixel p = field_.pixels[size_t(i)];
  return level_.phase.penalty(p.x + dx, p.y + dy, i % field_.size.width * block_, i / field_.size.width * block_);
}

ExemplarPixel PieceGround::on_side(ExemplarPixel p, int dx, int dy, int k) const {
  const int far = block_ - 1;
  int u = p.x + (dx > 0 ? far : dx < 0 ? 0 : k), v = p.y + (dy > 0 ? far : dy < 0 ? 0 : k);
  level_.exemplar.settle(u, v);
  return {uint16_t(u), uint16_t(v)};
}

}  // namespace terrazzo
