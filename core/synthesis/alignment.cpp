#include "core/synthesis/alignment.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include <tbb/parallel_for.h>

#include "core/synthesis/pieces.h"

namespace terrazzo {

namespace {

constexpr int smallest_piece = 4;  // pixels; smaller ones are left to correction
constexpr int sweeps = 2;
constexpr size_t many_seams = 1000;
// A move must lower the mismatch by this much, in 1/64.
constexpr int64_t worthwhile = 61;

class PieceAligner {
 public:
  PieceAligner(Field& field, int block, const CorrectionLevel& level, int reach, const Task& task)
      : field_(field),
        block_(block),
        level_(level),
        reach_(reach),
        task_(task),
        pieces_(field, block, level.window.closed_x, level.window.closed_y),
        moved_(size_t(pieces_.count()), -1) {
    find_borders();
    find_rounds();
  }

  void align() {
    for (int sweep = 0; sweep < sweeps; sweep++)
      for (int round = 0; round < rounds(); round++)
        tbb::parallel_for(round_begin_[round], round_begin_[round + 1], [&](int i) {
          task_.check();
          const int piece = movable_[i], turn = sweep * rounds() + round;
          if (sweep > 0 && !changed_since(piece, turn - rounds())) return;
          if (move(piece)) moved_[size_t(piece)] = turn;
        });
  }

 private:
  struct Seam {
    ExemplarPixel inside;  ///< what the piece shows on its side
    ExemplarPixel beyond;  ///< what the neighbour shows
    int dx, dy;            ///< from inside to beyond
  };
  using Seams = std::vector<Seam>;

  bool can_move(int piece) const { return pieces_.area(piece) * block_ * block_ >= smallest_piece && !is_fixed(piece); }

  /// The pixel beyond a side; -1 if there is none.
  int64_t beyond(int pixel, int side) const {
    return pixel_beside(field_.size, pixel, side, level_.window.closed_x, level_.window.closed_y);
  }

  /// Calls `visit(pixel, side)` for each side of a piece's pixels that is a border with another piece.
  template <typename Visit>
  void for_each_border(int piece, const Visit& visit) const {
    for (const int i : pieces_.members(piece))
      for (int side = 0; side < 4; side++) {
        const int64_t n = beyond(i, side);
        if (n >= 0 && pieces_.of(int(n)) != piece) visit(uint32_t(i), uint32_t(side));
      }
  }

  /// Where the pieces that can move meet others. That stays, since a move changes what pixels show, not whose they are.
  void find_borders() {
    const int count = pieces_.count();
    border_begin_.assign(size_t(count) + 1, 0);
    const auto for_each_movable = [&](const auto& visit) {
      tbb::parallel_for(0, count, [&](int piece) {
        if (can_move(piece)) visit(piece);
      });
    };
    for_each_movable([&](int piece) {
      uint32_t sum = 0;
      for_each_border(piece, [&](uint32_t, uint32_t) { sum++; });
      border_begin_[size_t(piece) + 1] = sum;
    });
    task_.check();
    std::partial_sum(border_begin_.begin(), border_begin_.end(), border_begin_.begin());
    borders_.resize(border_begin_.back());
    for_each_movable([&](int piece) {
      uint32_t at = border_begin_[piece];
      for_each_border(piece, [&](uint32_t pixel, uint32_t side) { borders_[at++] = pixel << 2 | side; });
    });
    task_.check();
  }

  std::span<const uint32_t> borders(int piece) const {
    return {borders_.data() + border_begin_[piece], border_begin_[size_t(piece) + 1] - border_begin_[piece]};
  }

  /// Pieces move one after the other, the largest first. Those that do not meet can move at the same time: a piece has
  /// its turn one round after the last of its larger neighbours.
  void find_rounds() {
    std::vector<int> order;
    for (int piece = 0; piece < pieces_.count(); piece++)
      if (!borders(piece).empty()) order.push_back(piece);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return pieces_.area(a) > pieces_.area(b); });
    std::vector<int> turn(size_t(pieces_.count()), 0);  // 0: not yet known
    std::vector<int> sizes;
    for (const int piece : order) {
      int last = 0;
      for (const uint32_t b : borders(piece)) last = std::max(last, turn[pieces_.of(int(beyond(int(b >> 2), b & 3)))]);
      turn[piece] = last + 1;
      if (last == int(sizes.size())) sizes.push_back(0);
      sizes[last]++;
    }
    round_begin_.assign(sizes.size() + 1, 0);
    std::partial_sum(sizes.begin(), sizes.end(), round_begin_.begin() + 1);
    std::vector<int> next(round_begin_.begin(), round_begin_.end());
    movable_.resize(order.size());
    for (const int piece : order) movable_[next[turn[piece] - 1]++] = piece;
  }

  int rounds() const { return int(round_begin_.size()) - 1; }

  /// Whether a piece or one beside it has moved in a turn or after it. If not, to move the piece again changes nothing.
  bool changed_since(int piece, int turn) const {
    if (moved_[size_t(piece)] >= turn) return true;
    return std::ranges::any_of(borders(piece), [&](uint32_t b) {
      return moved_[size_t(pieces_.of(int(beyond(int(b >> 2), int(b & 3)))))] >= turn;
    });
  }

  /// The k-th pixel along one of the sides of the block that begins with p.
  ExemplarPixel on_side(ExemplarPixel p, int dx, int dy, int k) const {
    const int far = block_ - 1;
    int u = p.x + (dx > 0 ? far : dx < 0 ? 0 : k), v = p.y + (dy > 0 ? far : dy < 0 ? 0 : k);
    level_.exemplar.settle(u, v);
    return {uint16_t(u), uint16_t(v)};
  }

  Seams seams_of(int piece) const {
    Seams seams;
    seams.reserve(borders(piece).size() * block_);
    for (const uint32_t b : borders(piece)) {
      const int i = int(b >> 2), side = int(b & 3);
      const auto [dx, dy] = sides[side];
      const ExemplarPixel p = field_.pixels[i], q = field_.pixels[size_t(beyond(i, side))];
      for (int k = 0; k < block_; k++) seams.push_back({on_side(p, dx, dy, k), on_side(q, -dx, -dy, k), dx, dy});
    }
    return seams;
  }

  /// Whether the exemplar has usable pixels for the whole piece where a move would take it.
  bool has_room(int piece, int dx, int dy) const {
    const std::span<const int> members = pieces_.members(piece);
    return std::all_of(members.begin(), members.end(), [&](int i) {
      const ExemplarPixel p = field_.pixels[i];
      const int x = p.x + dx, y = p.y + dy, far = block_ - 1;
      return level_.exemplar.holds(x, y) && level_.exemplar.holds(x + far, y + far);
    });
  }

  bool is_fixed(int piece) const {
    if (!level_.fixed.any()) return false;
    const std::span<const int> members = pieces_.members(piece);
    return std::any_of(members.begin(), members.end(), [&](int i) { return level_.fixed.at(size_t(i)); });
  }

  int64_t mismatch(const Seams& seams, int dx, int dy, int64_t limit) const {
    const PaddedLevel& e = level_.exemplar;
    int64_t sum = 0;
    for (const Seam& s : seams) {
      int u = s.inside.x + dx, v = s.inside.y + dy;
      e.settle(u, v);
      sum += squared_distance(*e.at(u, v), *e.at(s.beyond.x - s.dx, s.beyond.y - s.dy));
      sum += squared_distance(*e.at(u + s.dx, v + s.dy), *e.at(s.beyond.x, s.beyond.y));
      if (sum >= limit) break;
    }
    return sum;
  }

  int64_t cost(int piece, const Seams& seams, int dx, int dy, int64_t limit) const {
    int64_t c = mismatch(seams, dx, dy, limit);
    if (!level_.phase.active() || c >= limit) return c;
    const int i = pieces_.members(piece)[0];
    const ExemplarPixel p = field_.pixels[i];
    return int64_t(double(c) * level_.phase.penalty(p.x + dx, p.y + dy, i % field_.size.width * block_,
                                                    i / field_.size.width * block_));
  }

  /// Whether the piece has moved.
  bool move(int piece) {
    const Seams seams = seams_of(piece);
    const int64_t stay = cost(piece, seams, 0, 0, std::numeric_limits<int64_t>::max()) * worthwhile / 64;
    const int across = 2 * reach_ + 1, moves = across * across;
    const auto cost_of = [&](int m, int64_t limit) {
      return cost(piece, seams, m % across - reach_, m / across - reach_, limit);
    };
    // Where few pieces are left to a round, the largest keep all threads busy.
    std::vector<int64_t> costs;
    if (seams.size() >= many_seams) {
      costs.resize(size_t(moves));
      tbb::parallel_for(0, moves, [&](int m) { costs[size_t(m)] = cost_of(m, stay); });
    }
    int64_t least = stay;
    int best_x = 0, best_y = 0;
    for (int m = 0; m < moves; m++) {
      const int dx = m % across - reach_, dy = m / across - reach_;
      if (dx == 0 && dy == 0) continue;
      const int64_t c = costs.empty() ? cost_of(m, least) : costs[size_t(m)];
      if (c >= least || !has_room(piece, dx, dy)) continue;
      least = c;
      best_x = dx;
      best_y = dy;
    }
    if (best_x == 0 && best_y == 0) return false;
    for (const int i : pieces_.members(piece)) {
      ExemplarPixel& p = field_.pixels[i];
      int u = p.x + best_x, v = p.y + best_y;
      level_.exemplar.settle_inside(u, v);
      p = {uint16_t(u), uint16_t(v)};
    }
    return true;
  }

  Field& field_;
  int block_;
  const CorrectionLevel& level_;
  int reach_;
  const Task& task_;
  Pieces pieces_;
  std::vector<uint32_t> border_begin_;  // of every piece in borders_
  std::vector<uint32_t> borders_;       // pixel * 4 + side, piece by piece
  std::vector<int> round_begin_;        // of every round in movable_
  std::vector<int> movable_;            // pieces, round by round
  std::vector<int> moved_;              // the last turn in which each piece moved
};

}  // namespace

void align_pieces(Field& field, int block, const CorrectionLevel& level, int reach, const Task& task) {
  PieceAligner(field, block, level, reach, task).align();
}

}  // namespace terrazzo
