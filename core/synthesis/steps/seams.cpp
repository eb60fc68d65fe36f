#include "core/synthesis/steps/seams.h"

#include <algorithm>
#include <numeric>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "core/base/tuning.h"
#include "core/synthesis/state/expansion.h"
#include "core/synthesis/state/pieces.h"
#include "core/synthesis/state/rounds.h"

namespace terrazzo {

namespace {

struct SeamsTuning {
  double fair_unary_cost = appearance_limit / 55.0;
  double most_unary_cost = 3;
  int sweeps = 1;
};
const Tunable<SeamsTuning> seams_tuning(
    "seams",
    {
        {&SeamsTuning::fair_unary_cost, "fair_unary_cost", "appearance units per pixel",
         "the cost of a pixel in a piece of a fair size. Higher: large pieces give way; lower: they swallow small ones",
         "seams", 0, 10000},
        {&SeamsTuning::most_unary_cost, "most_unary_cost", "fair_unary_cost",
         "higher: the largest pieces give way still more; lower: from some size on they grow", "seams", 0, 1000},
        {&SeamsTuning::sweeps, "sweeps", "rounds over all pieces",
         "higher: seams follow those that moved after them; costs time", "seams"},
    });

class SeamMover {
 public:
  SeamMover(ExpansionProblem& problem, const Field& before, const SeamMoves& moves)
      : problem_(problem),
        before_(before),
        reach_(moves.reach),
        distance_penalty_(int32_t(moves.distance_penalty * mismatch_unit)),
        expansion_(problem) {}

  /// Offers the piece's remaining pixels' continuations to the pixels in its reach, at that cost and more per distance.
  void spread(std::span<const int> piece, int32_t unary_cost) {
    std::vector<Reached> rim, next;
    for (const int i : piece) {
      if (!(problem_.field.pixels[i] == before_.pixels[i])) continue;
      expansion_.keep(i);
      rim.push_back({i, before_.pixels[i]});
    }
    for (int r = 0; r < reach_; r++) {
      next.clear();
      for (const Reached& from : rim)
        for (int side = 0; side < 4; side++) {
          const int64_t n = problem_.plane.beside(from.pixel, side);
          if (n < 0) continue;
          Reached reached{int(n), from.shown};
          if (step(reached.shown, side) &&
              expansion_.offer(reached.pixel, reached.shown, unary_cost + (r + 1) * distance_penalty_))
            next.push_back(reached);
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

  /// Steps to the exemplar's neighbour on that side, around its border if it tiles, if it has one.
  bool step(ExemplarPixel& p, int side) const {
    const int block = problem_.level.block;
    int x = p.x + sides[side][0] * block, y = p.y + sides[side][1] * block;
    if (!problem_.level.goes_on(x, y)) return false;
    p = {uint16_t(x), uint16_t(y)};
    return true;
  }

  ExpansionProblem& problem_;
  const Field& before_;
  int reach_;
  int32_t distance_penalty_;
  Expansion expansion_;
};

/// The cost of a pixel in each piece, by its size. Pieces with fixed pixels cannot shrink and count as fair.
std::vector<int32_t> unary_costs(const Pieces& pieces, double fair, const FixedPixels& fixed) {
  std::vector<int32_t> out(size_t(pieces.count()), 0);
  if (fair <= 0) return out;
  for (int piece = 0; piece < pieces.count(); piece++) {
    const bool kept =
        fixed.any() && std::ranges::any_of(pieces.members(piece), [&](int i) { return fixed.at(size_t(i)); });
    out[size_t(piece)] = int32_t(seams_tuning->fair_unary_cost * mismatch_unit *
                                 (kept ? 1 : std::min(seams_tuning->most_unary_cost, pieces.area(piece) / fair)));
  }
  return out;
}

void sweep(Field& field, const CorrectionLevel& level, const SeamMoves& moves, const Task& task) {
  const Pieces pieces(field, level);
  std::vector<int> order(size_t(pieces.count()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return pieces.area(a) > pieces.area(b); });
  Rounds rounds(level.window.field(), moves.reach);
  for (const int piece : order) rounds.add(piece, pieces.members(piece));
  const Field before = field;
  const std::vector<int32_t> unary_cost = unary_costs(pieces, moves.target_area, level.fixed);
  ExpansionProblem problem(field, level, true);
  problem.unary_cost.resize(field.pixels.size());
  for (int piece = 0; piece < pieces.count(); piece++)
    for (const int i : pieces.members(piece)) problem.unary_cost[size_t(i)] = unary_cost[size_t(piece)];
  tbb::enumerable_thread_specific<SeamMover> movers([&] { return SeamMover(problem, before, moves); });
  size_t done = 0;
  for (const std::vector<int>& round : rounds.all()) {
    task.progress(double(done++) / double(rounds.all().size()));
    tbb::parallel_for(0, int(round.size()), [&](int i) {
      task.check();
      const int piece = round[size_t(i)];
      movers.local().spread(pieces.members(piece), unary_cost[size_t(piece)]);
    });
  }
}

}  // namespace

void move_seams(Field& field, const CorrectionLevel& level, const SeamMoves& moves, const Task& task) {
  const int sweeps = seams_tuning->sweeps;
  for (int i = 0; i < sweeps; i++)
    sweep(field, level, moves, task.part([&](double done) { task.progress((i + done) / sweeps); }));
}

}  // namespace terrazzo
