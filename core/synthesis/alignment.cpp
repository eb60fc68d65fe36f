#include "core/synthesis/alignment.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/synthesis/pieces.h"

namespace terrazzo {

namespace {

constexpr int sides[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
constexpr int smallest_piece = 4;  // pixels; smaller ones are left to correction
constexpr int sweeps = 2;
// A move must lower the mismatch by this much, in 1/64.
constexpr int64_t worthwhile = 61;

class PieceAligner {
 public:
  PieceAligner(Field& field, int block, const CorrectionLevel& level, int reach)
      : field_(field), block_(block), level_(level), reach_(reach), pieces_(field, level.exemplar, block) {}

  void align(const Task& task) {
    std::vector<int> order(pieces_.count());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return pieces_.area(a) > pieces_.area(b); });
    for (int sweep = 0; sweep < sweeps; sweep++)
      for (const int piece : order) {
        if (pieces_.area(piece) * block_ * block_ < smallest_piece) break;
        task.check();
        move(piece);
      }
  }

 private:
  struct Seam {
    ExemplarPixel inside;  ///< what the piece shows on its side
    ExemplarPixel beyond;  ///< what the neighbour shows
    int dx, dy;            ///< from inside to beyond
  };

  /// The k-th pixel along one of the sides of the block that begins with p.
  ExemplarPixel on_side(ExemplarPixel p, int dx, int dy, int k) const {
    const int far = block_ - 1;
    int u = p.x + (dx > 0 ? far : dx < 0 ? 0 : k), v = p.y + (dy > 0 ? far : dy < 0 ? 0 : k);
    level_.exemplar.settle(u, v);
    return {uint16_t(u), uint16_t(v)};
  }

  void gather(int piece) {
    seams_.clear();
    low_ = {65535, 65535};
    high_ = {0, 0};
    for (const int i : pieces_.members(piece)) {
      const ExemplarPixel p = field_.pixels[i];
      low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
      high_ = {std::max(high_.x, uint16_t(p.x + block_ - 1)), std::max(high_.y, uint16_t(p.y + block_ - 1))};
      for (const auto& s : sides) {
        const int64_t n = pixel_index(field_.size, i % field_.size.width + s[0], i / field_.size.width + s[1],
                                      level_.window.closed_x, level_.window.closed_y);
        if (n < 0 || pieces_.of(int(n)) == piece) continue;
        const ExemplarPixel q = field_.pixels[size_t(n)];
        for (int k = 0; k < block_; k++)
          seams_.push_back({on_side(p, s[0], s[1], k), on_side(q, -s[0], -s[1], k), s[0], s[1]});
      }
    }
  }

  bool stays(ExemplarPixel p, int dx, int dy) const {
    int u = p.x + dx, v = p.y + dy;
    if (!level_.exemplar.settles(u, v)) return false;
    return level_.exemplar.wraps() || (u == p.x + dx && v == p.y + dy);
  }

  /// Whether the exemplar has usable pixels for the whole piece where a move would take it.
  bool has_room(int piece, int dx, int dy) const {
    if (!level_.exemplar.masked()) return level_.exemplar.wraps() || (stays(low_, dx, dy) && stays(high_, dx, dy));
    const std::span<const int> members = pieces_.members(piece);
    return std::all_of(members.begin(), members.end(), [&](int i) {
      const ExemplarPixel p = field_.pixels[i];
      return stays(p, dx, dy) && stays(p, dx + block_ - 1, dy + block_ - 1);
    });
  }

  bool is_fixed(int piece) const {
    if (!level_.fixed.any()) return false;
    const std::span<const int> members = pieces_.members(piece);
    return std::any_of(members.begin(), members.end(), [&](int i) { return level_.fixed.at(size_t(i)); });
  }

  int64_t mismatch(int dx, int dy, int64_t limit) const {
    const PaddedLevel& e = level_.exemplar;
    int64_t sum = 0;
    for (const Seam& s : seams_) {
      int u = s.inside.x + dx, v = s.inside.y + dy;
      e.settle(u, v);
      sum += squared_distance(*e.at(u, v), *e.at(s.beyond.x - s.dx, s.beyond.y - s.dy));
      sum += squared_distance(*e.at(u + s.dx, v + s.dy), *e.at(s.beyond.x, s.beyond.y));
      if (sum >= limit) break;
    }
    return sum;
  }

  int64_t cost(int piece, int dx, int dy, int64_t limit) const {
    int64_t c = mismatch(dx, dy, limit);
    if (!level_.phase.active() || c >= limit) return c;
    const int i = pieces_.members(piece)[0];
    const ExemplarPixel p = field_.pixels[i];
    return int64_t(double(c) * level_.phase.penalty(p.x + dx, p.y + dy, i % field_.size.width * block_,
                                                    i / field_.size.width * block_));
  }

  void move(int piece) {
    if (is_fixed(piece)) return;
    gather(piece);
    if (seams_.empty()) return;
    int64_t least = cost(piece, 0, 0, std::numeric_limits<int64_t>::max()) * worthwhile / 64;
    int best_x = 0, best_y = 0;
    for (int dy = -reach_; dy <= reach_; dy++)
      for (int dx = -reach_; dx <= reach_; dx++) {
        if (dx == 0 && dy == 0) continue;
        const int64_t c = cost(piece, dx, dy, least);
        if (c >= least || !has_room(piece, dx, dy)) continue;
        least = c;
        best_x = dx;
        best_y = dy;
      }
    if (best_x == 0 && best_y == 0) return;
    for (const int i : pieces_.members(piece)) {
      ExemplarPixel& p = field_.pixels[i];
      int u = p.x + best_x, v = p.y + best_y;
      level_.exemplar.settle_inside(u, v);
      p = {uint16_t(u), uint16_t(v)};
    }
  }

  Field& field_;
  int block_;
  const CorrectionLevel& level_;
  int reach_;
  Pieces pieces_;
  std::vector<Seam> seams_;
  ExemplarPixel low_, high_;  // what the piece spans in the exemplar
};

}  // namespace

void align_pieces(Field& field, int block, const CorrectionLevel& level, int reach, const Task& task) {
  PieceAligner(field, block, level, reach).align(task);
}

}  // namespace terrazzo
