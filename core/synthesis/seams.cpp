#include "core/synthesis/seams.h"

#include <algorithm>
#include <numeric>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "core/synthesis/expansion.h"
#include "core/synthesis/pieces.h"
#include "core/synthesis/rounds.h"

namespace terrazzo {

namespace {

constexpr int smallest_piece = 2;  // pixels; smaller ones only give way

class SeamMover {
 public:
  SeamMover(ExpansionGround& ground, const Field& before, int reach)
      : ground_(ground), before_(before), reach_(reach), expansion_(ground) {}

  /// Offers what is left of the piece to the pixels in its reach.
  void spread(std::span<const int> piece) {
    std::vector<Reached> rim, next;
    for (const int i : piece) {
      if (!(ground_.field.pixels[i] == before_.pixels[i])) continue;
      expansion_.keep(i);
      rim.push_back({i, before_.pixels[i]});
    }
    for (int r = 0; r < reach_; r++) {
      next.clear();
      for (const Reached& from : rim)
        for (int side = 0; side < 4; side++) {
          const int64_t n = beside(from.pixel, side);
          if (n < 0) continue;
          Reached reached{int(n), from.shown};
          if (step(reached.shown, side) && expansion_.offer(reached.pixel, reached.shown)) next.push_back(reached);
        }
      rim.swap(next);
    }
    expansion_.apply();
  }

 private:
  struct Reached {
    int pixel;
    ExemplarPixel shown;
  };

  int64_t beside(int pixel, int side) const {
    const PlaneWindow& window = ground_.level.window;
    return pixel_beside(ground_.field.size, pixel, side, window.closed_x, window.closed_y);
  }

  /// Whether the exemplar goes on there; moves to it.
  bool step(ExemplarPixel& p, int side) const {
    const int x = p.x + sides[side][0], y = p.y + sides[side][1];
    int u = x, v = y;
    if (!ground_.level.exemplar.settles(u, v) || u != x || v != y) return false;
    p = {uint16_t(u), uint16_t(v)};
    return true;
  }

  ExpansionGround& ground_;
  const Field& before_;
  int reach_;
  Expansion expansion_;
};

}  // namespace

void move_seams(Field& field, const CorrectionLevel& level, int reach, const Task& task) {
  const Pieces pieces(field, 1, level.window.closed_x, level.window.closed_y);
  std::vector<int> order(size_t(pieces.count()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return pieces.area(a) > pieces.area(b); });
  Rounds rounds(field, level.window, reach);
  for (const int piece : order)
    if (pieces.area(piece) >= smallest_piece) rounds.add(piece, pieces.members(piece));
  const Field before = field;
  ExpansionGround ground(field, level);
  tbb::enumerable_thread_specific<SeamMover> movers([&] { return SeamMover(ground, before, reach); });
  for (const std::vector<int>& round : rounds.all())
    tbb::parallel_for(0, int(round.size()), [&](int i) {
      task.check();
      movers.local().spread(pieces.members(round[size_t(i)]));
    });
}

}  // namespace terrazzo
