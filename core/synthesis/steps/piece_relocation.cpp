#include "core/synthesis/steps/piece_relocation.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "core/base/hash.h"
#include "core/base/tuning.h"
#include "core/synthesis/state/candidate_votes.h"
#include "core/synthesis/state/piece_seams.h"
#include "core/synthesis/state/rounds.h"
#include "core/synthesis/state/usage_penalty.h"

namespace terrazzo {

namespace {

struct PieceRelocationTuning {
  double repeated = 0.05;
  double worthwhile = 0.9;
  int smallest_piece = 16;
  int near = 8;
  int voting_seams = 128;
  int random_places = 256;
  int usage_samples = 16;
};
const Tunable<PieceRelocationTuning> piece_relocation_tuning(
    "piece_relocation",
    {
        {&PieceRelocationTuning::repeated, "repeated", "share of a piece",
         "so much of a piece may show near by already. Higher: more places may fit; lower: less repeats",
         "piece_relocation", 0, 1},
        {&PieceRelocationTuning::worthwhile, "worthwhile", "share of the misfit",
         "what a move must lower it to. Higher: pieces move for small gains; lower: they stay in place",
         "not measured: a move must be worth the change"},
        {&PieceRelocationTuning::smallest_piece, "smallest_piece", "blocks",
         "higher: less time; smaller pieces are left to correction. Lower: small pieces find better places",
         "not measured: smaller pieces are left to correction"},
        {&PieceRelocationTuning::near, "near", "blocks",
         "higher: repeats must be farther apart; lower: more places may fit", "piece_relocation", 0, 1000},
        {&PieceRelocationTuning::voting_seams, "voting_seams", "seam pixels",
         "higher: more of a seam proposes candidates; costs time", "not measured: bounds the time of large pieces"},
        {&PieceRelocationTuning::random_places, "random_places", "candidates for a piece",
         "higher: better places are found, which are used more often; costs time. Lower: use stays even",
         "piece_relocation"},
        {&PieceRelocationTuning::usage_samples, "usage_samples", "pixels of a piece",
         "higher: usage is known more exactly; costs time", "not measured: bounds the time of each candidate", 1},
    });

constexpr int64_t no_limit = std::numeric_limits<int64_t>::max();

/// The offset from what a piece shows to what it might show.
struct Move {
  int dx = 0;
  int dy = 0;

  static Move unpacked(uint32_t m) { return {int(m & 0xffff) - 0x8000, int(m >> 16) - 0x8000}; }
  uint32_t packed() const { return uint32_t(dy + 0x8000) << 16 | uint32_t(dx + 0x8000); }
};

/// A piece's bounds in the exemplar. They are contiguous there even if the piece wraps around the field's border.
struct Outline {
  int first = 0;           ///< its first pixel in the field
  ExemplarPixel at_first;  ///< what that shows
  ExemplarPixel low, high;

  Outline(const Field& field, std::span<const int> members) : first(members[0]), at_first(field.pixels[size_t(first)]) {
    low = high = at_first;
    for (const int i : members) {
      const ExemplarPixel p = field.pixels[size_t(i)];
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  }
};

/// Relocates one piece at a time. One per thread.
class Relocator {
 public:
  Relocator(Field& field, int block, const CorrectionLevel& level, const PieceGround& ground, const UsagePenalty& usage,
            uint64_t seed)
      : field_(field),
        block_(block),
        level_(level),
        ground_(ground),
        pieces_(ground.pieces()),
        usage_(usage),
        seed_(seed) {}

  void relocate(int piece) {
    find_seams(piece);
    const Outline outline(field_, pieces_.members(piece));
    propose_moves(outline);
    int64_t least = int64_t(double(cost(piece, {}, no_limit)) * piece_relocation_tuning->worthwhile);
    Move best;
    for (const auto& [packed, votes] : moves_.by_votes()) {
      const Move move = Move::unpacked(packed);
      const int64_t c = cost(piece, move, least);
      if (c >= least || !ground_.has_room(piece, move.dx, move.dy) || joins_neighbour(move) ||
          shows_near(piece, outline, move))
        continue;
      least = c;
      best = move;
    }
    for (const int i : pieces_.members(piece)) {
      ExemplarPixel& p = field_.pixels[size_t(i)];
      p = {uint16_t(p.x + best.dx), uint16_t(p.y + best.dy)};
    }
  }

  /// The mean mismatch along a piece's seams.
  double misfit(int piece) {
    find_seams(piece);
    return seams_.empty() ? 0 : double(ground_.mismatch(seams_, 0, 0, no_limit)) / double(seams_.size());
  }

  /// The field's pixels within a piece's bounds.
  std::vector<int> pixels_within(const Outline& o) const {
    std::vector<int> pixels;
    for (int v = o.low.y; v <= o.high.y; v += block_)
      for (int u = o.low.x; u <= o.high.x; u += block_) {
        const int64_t i = pixel_showing(o, u, v);
        if (i >= 0) pixels.push_back(int(i));
      }
    return pixels;
  }

 private:
  /// Each far from the one before, so that sums soon exceed their limit.
  void find_seams(int piece) {
    in_order_.clear();
    seams_.clear();
    ground_.for_each_border(
        piece, [&](uint32_t pixel, uint32_t side) { ground_.add_seams(int(pixel), int(side), in_order_); });
    const size_t count = in_order_.size();
    size_t stride = (count * 5 / 8) | 1;
    while (std::gcd(stride, count) > 1) stride += 2;
    for (size_t i = 0; i < count; i++) seams_.push_back(in_order_[i * stride % count]);
  }

  /// The field's pixel that would show an exemplar position if the piece extended there; -1 if there is none.
  int64_t pixel_showing(const Outline& o, int u, int v) const {
    const auto blocks = [this](int d) { return d >= 0 ? d / block_ : -((block_ - 1 - d) / block_); };
    return pixel_index(field_.size, o.first % field_.size.width + blocks(u - o.at_first.x),
                       o.first / field_.size.width + blocks(v - o.at_first.y), level_.window.closed_x,
                       level_.window.closed_y);
  }

  void propose_moves(const Outline& o) {
    moves_.clear();
    for (size_t i = 0; i < std::min(seams_.size(), size_t(piece_relocation_tuning->voting_seams)); i++) {
      const PieceSeam& s = seams_[i];
      propose_similar(o, s.inside, s.inside.x, s.inside.y);
      propose_similar(o, s.beyond, s.inside.x + s.dx, s.inside.y + s.dy);
    }
    for (int k = 0; k < piece_relocation_tuning->random_places; k++) {
      const auto [u, v] = level_.exemplar.place(random_bits(seed_, level_.level, o.first, k));
      propose(o, {u - o.at_first.x, v - o.at_first.y});
    }
  }

  /// Proposes moves of (x, y) to the k-coherent candidates of that pixel.
  void propose_similar(const Outline& o, ExemplarPixel pixel, int x, int y) {
    const size_t first = (size_t(pixel.y) * level_.exemplar.size().width + pixel.x) * size_t(level_.per_pixel);
    for (int k = 0; k < level_.per_pixel; k++) {
      const ExemplarPixel similar = level_.similar[first + size_t(k)];
      propose(o, {similar.x - x, similar.y - y});
    }
  }

  /// Proposes the nearest move in phase, if the piece stays in the exemplar.
  void propose(const Outline& o, const Move& move) {
    int u = o.at_first.x + move.dx, v = o.at_first.y + move.dy;
    level_.phase.snap(o.first % field_.size.width * block_, o.first / field_.size.width * block_, u, v);
    const Move m{u - o.at_first.x, v - o.at_first.y};
    const Size e = level_.exemplar.size();
    if (o.low.x + m.dx < 0 || o.low.y + m.dy < 0 || o.high.x + m.dx >= e.width || o.high.y + m.dy >= e.height) return;
    if (m.dx != 0 || m.dy != 0) moves_.add(m.packed());
  }

  int64_t cost(int piece, const Move& m, int64_t limit) const {
    const double factor = ground_.penalty(piece, m.dx, m.dy) * usage_factor(piece, m);
    const int64_t c = ground_.mismatch(seams_, m.dx, m.dy, limit == no_limit ? limit : int64_t(limit / factor) + 1);
    return int64_t(double(c) * factor);
  }

  /// The mean usage penalty of what a piece would show, from some of its pixels.
  double usage_factor(int piece, const Move& m) const {
    if (!usage_.active()) return 1;
    const std::span<const int> members = pieces_.members(piece);
    const size_t step = std::max<size_t>(1, members.size() / size_t(piece_relocation_tuning->usage_samples));
    const Size e = level_.exemplar.size();
    uint64_t sum = 0, count = 0;
    for (size_t i = step / 2; i < members.size(); i += step, count++) {
      const ExemplarPixel p = field_.pixels[size_t(members[i])];
      sum += usage_.factor(std::min(p.x + m.dx, e.width - 1), std::min(p.y + m.dy, e.height - 1));
    }
    return double(sum) / double(count) / unit_factor;
  }

  bool joins_neighbour(const Move& m) const {
    return std::any_of(seams_.begin(), seams_.end(), [&](const PieceSeam& s) {
      return s.inside.x + m.dx + s.dx == s.beyond.x && s.inside.y + m.dy + s.dy == s.beyond.y;
    });
  }

  bool shows_near(int piece, const Outline& o, const Move& m) const {
    const int most = int(piece_relocation_tuning->repeated * pieces_.area(piece)),
              around = piece_relocation_tuning->near * block_;
    int shown = 0;
    for (int v = o.low.y - around; v <= o.high.y + around; v += block_)
      for (int u = o.low.x - around; u <= o.high.x + around; u += block_) {
        const int64_t i = pixel_showing(o, u, v);
        if (i < 0 || pieces_.of(int(i)) == piece) continue;
        const int own_u = field_.pixels[size_t(i)].x - m.dx, own_v = field_.pixels[size_t(i)].y - m.dy;
        if (own_u < o.low.x || own_v < o.low.y || own_u > o.high.x || own_v > o.high.y) continue;
        const int64_t own = pixel_showing(o, own_u, own_v);
        if (own >= 0 && pieces_.of(int(own)) == piece && ++shown > most) return true;
      }
    return false;
  }

  Field& field_;
  int block_;
  const CorrectionLevel& level_;
  const PieceGround& ground_;
  const Pieces& pieces_;
  const UsagePenalty& usage_;
  uint64_t seed_;
  PieceSeams in_order_;
  PieceSeams seams_;  // of the piece at hand
  CandidateVotes moves_;
};

}  // namespace

void relocate_pieces(Field& field, int block, const CorrectionLevel& level, const UsagePenalty& usage, uint64_t seed,
                     const Task& task) {
  const PieceGround ground(field, block, level);
  const Pieces& pieces = ground.pieces();
  tbb::enumerable_thread_specific<Relocator> relocators(
      [&] { return Relocator(field, block, level, ground, usage, seed); });
  std::vector<int> order;
  for (int piece = 0; piece < pieces.count(); piece++)
    if (pieces.area(piece) >= piece_relocation_tuning->smallest_piece && !ground.is_fixed(piece))
      order.push_back(piece);
  std::vector<double> misfits(size_t(pieces.count()), 0.0);
  tbb::parallel_for(size_t{0}, order.size(), [&](size_t i) {
    task.check();
    misfits[size_t(order[i])] = relocators.local().misfit(order[i]);
  });
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return misfits[a] > misfits[b]; });
  Rounds rounds(field, level.window, piece_relocation_tuning->near / 3 + 1);
  for (const int piece : order)
    rounds.add(piece, relocators.local().pixels_within(Outline(field, pieces.members(piece))));
  for (const std::vector<int>& round : rounds.all())
    tbb::parallel_for(0, int(round.size()), [&](int i) {
      task.check();
      relocators.local().relocate(round[size_t(i)]);
    });
}

}  // namespace terrazzo
