#include "core/synthesis/steps/alignment.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include <tbb/parallel_for.h>

#include "core/base/tuning.h"
#include "core/synthesis/state/piece_seams.h"

namespace terrazzo {

namespace {

struct AlignmentTuning {
  int smallest_piece = 4;
  int sweeps = 2;
  int worthwhile = 61;
};
const Tunable<AlignmentTuning> alignment_tuning(
    "alignment",
    {
        {&AlignmentTuning::smallest_piece, "smallest_piece", "pixels of the level",
         "higher: less time; smaller pieces are left to correction. Lower: small pieces fit better when it begins",
         "not measured: smaller pieces are left to correction"},
        {&AlignmentTuning::sweeps, "sweeps", "rounds over all pieces",
         "higher: pieces follow neighbours that moved after them; costs time", "alignment"},
        {&AlignmentTuning::worthwhile, "worthwhile", "64ths of the mismatch",
         "what a move must lower it to. Higher: pieces move for small gains; lower: they stay in place",
         "not measured: a move must be worth the change; above 64 pieces would move for losses", 0, 64},
    });

constexpr int64_t worthwhile_unit = 64;
// From so many seams on a single piece's moves are tried in parallel. It changes the time only, not the result.
constexpr size_t many_seams = 1000;

class PieceAligner {
 public:
  PieceAligner(Field& field, int block, const CorrectionLevel& level, int reach, const Task& task)
      : field_(field),
        block_(block),
        level_(level),
        reach_(reach),
        task_(task),
        ground_(field, block, level),
        pieces_(ground_.pieces()),
        moved_(size_t(pieces_.count()), -1) {
    find_borders();
    find_rounds();
  }

  void align() {
    for (int sweep = 0; sweep < alignment_tuning->sweeps; sweep++)
      for (int round = 0; round < rounds(); round++)
        tbb::parallel_for(round_begin_[round], round_begin_[round + 1], [&](int i) {
          task_.check();
          const int piece = movable_[i], turn = sweep * rounds() + round;
          if (sweep > 0 && !changed_since(piece, turn - rounds())) return;
          if (move(piece)) moved_[size_t(piece)] = turn;
        });
  }

 private:
  bool can_move(int piece) const {
    return pieces_.area(piece) * block_ * block_ >= alignment_tuning->smallest_piece && !ground_.is_fixed(piece);
  }

  /// The borders of the pieces that can move. They do not change: a move changes what pixels show, not their pieces.
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
      ground_.for_each_border(piece, [&](uint32_t, uint32_t) { sum++; });
      border_begin_[size_t(piece) + 1] = sum;
    });
    task_.check();
    std::partial_sum(border_begin_.begin(), border_begin_.end(), border_begin_.begin());
    borders_.resize(border_begin_.back());
    for_each_movable([&](int piece) {
      uint32_t at = border_begin_[piece];
      ground_.for_each_border(piece, [&](uint32_t pixel, uint32_t side) { borders_[at++] = pixel << 2 | side; });
    });
    task_.check();
  }

  std::span<const uint32_t> borders(int piece) const {
    return {borders_.data() + border_begin_[piece], border_begin_[size_t(piece) + 1] - border_begin_[piece]};
  }

  /// Pieces move one after the other, the largest first. Those that do not meet can move at the same time: a piece
  /// moves one round after the last of its larger neighbours.
  void find_rounds() {
    std::vector<int> order;
    for (int piece = 0; piece < pieces_.count(); piece++)
      if (!borders(piece).empty()) order.push_back(piece);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return pieces_.area(a) > pieces_.area(b); });
    std::vector<int> turn(size_t(pieces_.count()), 0);  // 0: not yet known
    std::vector<int> sizes;
    for (const int piece : order) {
      int last = 0;
      for (const uint32_t b : borders(piece))
        last = std::max(last, turn[pieces_.of(int(ground_.beyond(int(b >> 2), b & 3)))]);
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

  /// Whether a piece or one of its neighbours has moved since a turn. If not, trying it again changes nothing.
  bool changed_since(int piece, int turn) const {
    if (moved_[size_t(piece)] >= turn) return true;
    return std::ranges::any_of(borders(piece), [&](uint32_t b) {
      return moved_[size_t(pieces_.of(int(ground_.beyond(int(b >> 2), int(b & 3)))))] >= turn;
    });
  }

  PieceSeams seams_of(int piece) const {
    PieceSeams seams;
    seams.reserve(borders(piece).size() * size_t(block_));
    for (const uint32_t b : borders(piece)) ground_.add_seams(int(b >> 2), int(b & 3), seams);
    return seams;
  }

  int64_t cost(int piece, const PieceSeams& seams, int dx, int dy, int64_t limit) const {
    const int64_t c = ground_.mismatch(seams, dx, dy, limit);
    return c >= limit ? c : int64_t(double(c) * ground_.penalty(piece, dx, dy));
  }

  /// Whether the piece has moved.
  bool move(int piece) {
    const PieceSeams seams = seams_of(piece);
    const int64_t stay =
        cost(piece, seams, 0, 0, std::numeric_limits<int64_t>::max()) * alignment_tuning->worthwhile / worthwhile_unit;
    const int across = 2 * reach_ + 1, moves = across * across;
    const auto cost_of = [&](int m, int64_t limit) {
      return cost(piece, seams, m % across - reach_, m / across - reach_, limit);
    };
    // Rounds of few, large pieces keep all threads busy by the moves of each piece.
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
      if (c >= least || !ground_.has_room(piece, dx, dy)) continue;
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
  PieceGround ground_;
  const Pieces& pieces_;
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
